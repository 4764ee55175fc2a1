//! An exponential that a compiler can vectorise: + - * and integer shifts only, so the same bits everywhere.

/// `e^x` for x in [0, 700].
///
/// `x = k ln 2 + r`, |r| <= ln 2 / 2, Taylor to degree 13 in r (remainder below 2e-18), then k into the exponent bits.
/// Accuracy: relative 4e-16 (test below). Guard: outside the domain the result is meaningless, but a number.
#[must_use]
#[inline]
#[allow(clippy::approx_constant, reason = "ln 2 in two parts, as Cody and Waite split it")]
pub fn exp(x: f64) -> f64 {
    /// 1.5 * 2^52: adding it rounds to an integer, which then stands in the low bits.
    const ROUND: f64 = 6_755_399_441_055_744.0;
    const LN2_HIGH: f64 = 6.931_471_803_691_238e-1;
    const LN2_LOW: f64 = 1.908_214_929_270_587_7e-10;
    let shifted = x * std::f64::consts::LOG2_E + ROUND;
    let k = shifted - ROUND;
    let r = (x - k * LN2_HIGH) - k * LN2_LOW;
    let mut p = COEFFICIENTS[0];
    for c in &COEFFICIENTS[1..] {
        p = p * r + c;
    }
    f64::from_bits(p.to_bits().wrapping_add(shifted.to_bits() << 52))
}

/// 1/13!, 1/12!, ..., 1/1!, 1/0!
const COEFFICIENTS: [f64; 14] = {
    let mut c = [1.0; 14];
    let mut factorial = 1.0;
    let mut n = 1;
    while n < 14 {
        factorial *= n as f64;
        c[13 - n] = 1.0 / factorial;
        n += 1;
    }
    c
};

#[cfg(test)]
mod tests {
    use super::exp;

    #[test]
    fn agrees_with_the_library() {
        let mut worst = 0.0f64;
        for i in 0..200_000 {
            let x = 60.0 * f64::from(i) / 200_000.0;
            let expected = libm::exp(x);
            worst = worst.max((exp(x) - expected).abs() / expected);
        }
        assert!(worst < 4.5e-16, "{worst:e}");
        assert!((exp(0.0) - 1.0).abs() == 0.0);
        assert!((exp(699.0) / libm::exp(699.0) - 1.0).abs() < 1e-15);
    }
}

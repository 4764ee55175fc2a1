//! Linear light as 8-bit codes.

/// The sRGB code of linear light, clamped to [0, 1].
///
/// Source: IEC 61966-2-1, 12.92 v up to 0.0031308, 1.055 v^(1/2.4) - 0.055 above.
#[must_use]
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "in [0, 255] by the clamp")]
pub fn code(v: f64) -> u8 {
    let v = v.clamp(0.0, 1.0);
    let code = if v <= 0.003_130_8 { 12.92 * v } else { 1.055 * libm::pow(v, 1.0 / 2.4) - 0.055 };
    (255.0 * code).round() as u8
}

#[cfg(test)]
mod tests {
    use super::code;

    #[test]
    fn codes_are_those_of_the_standard() {
        // middle grey of 18 % is code 118 in every table of the standard; 188 is half the light
        assert_eq!([0.0, 0.002, 0.18, 0.5, 1.0, 7.0, f64::NAN].map(code), [0, 7, 118, 188, 255, 255, 0]);
    }
}

//! The formula of a texture coordinate, computed as it is written, leads to the texel that holds the value.

use brdfbake::grid::{Axis, Direction, Quantity, Texel, Warp};

/// A formula with its rest.
struct Text<'a> {
    rest: &'a str,
    names: &'a [(&'a str, f64)],
}

impl Text<'_> {
    fn take(&mut self, sign: char) -> bool {
        let rest = self.rest.trim_start();
        let taken = rest.strip_prefix(sign);
        self.rest = taken.unwrap_or(rest);
        taken.is_some()
    }

    fn sum(&mut self) -> f64 {
        let mut value = self.product();
        loop {
            if self.take('+') {
                value += self.product();
            } else if self.take('-') {
                value -= self.product();
            } else {
                return value;
            }
        }
    }

    /// `a * b`, `a / b`, and `a b`.
    fn product(&mut self) -> f64 {
        let mut value = self.power();
        loop {
            let rest = self.rest.trim_start();
            if self.take('*') {
                value *= self.power();
            } else if self.take('/') {
                value /= self.power();
            } else if rest.starts_with(|c: char| c == '(' || c.is_ascii_alphanumeric()) {
                value *= self.power();
            } else {
                return value;
            }
        }
    }

    fn power(&mut self) -> f64 {
        let base = self.atom();
        if self.take('^') { libm::pow(base, self.atom()) } else { base }
    }

    fn atom(&mut self) -> f64 {
        if self.take('-') {
            return -self.atom();
        }
        if self.take('(') {
            let value = self.sum();
            assert!(self.take(')'), "no end of a bracket before `{}`", self.rest);
            return value;
        }
        let end = self.rest.find(|c: char| !(c.is_ascii_alphanumeric() || c == '_' || c == '.'));
        let (word, rest) = self.rest.split_at(end.unwrap_or(self.rest.len()));
        self.rest = rest;
        if word == "sqrt" {
            return self.atom().sqrt();
        }
        let named = self.names.iter().find(|(name, _)| *name == word).map(|(_, value)| *value);
        named.or_else(|| word.parse().ok()).unwrap_or_else(|| panic!("`{word}` is no name and no number"))
    }
}

/// A formula, and what `, c = ...` behind it says.
fn evaluate(formula: &str, names: &[(&str, f64)]) -> f64 {
    let (whole, c) = formula.split_once(", c = ").unwrap_or((formula, "1"));
    let mut all = names.to_vec();
    all.push(("c", number(c, names)));
    number(whole, &all)
}

fn number(text: &str, names: &[(&str, f64)]) -> f64 {
    let mut text = Text { rest: text, names };
    let value = text.sum();
    assert_eq!(text.rest.trim(), "", "the rest of a formula");
    value
}

#[test]
fn formulas_are_computed_as_they_are_written() {
    let names = [("mu", 0.25), ("alpha", 0.5)];
    for (formula, value) in [
        ("sqrt(mu) - -1 / 8", 0.625),
        ("1 - ((mu - 0.05) / 2)", 0.9),
        ("((1 - (mu)) * 3 + 0.5) / 4 - 2 / 4", 0.1875),
        ("(mu (1 + c) / (mu + c))^(1/2), c = alpha", 0.707_106_781_186_547_5),
        ("mu^2, c = 3 alpha^2", 0.0625),
    ] {
        assert!((evaluate(formula, &names) - value).abs() < 1e-15, "{formula}");
    }
}

#[test]
fn a_texture_coordinate_leads_to_its_texel() {
    let coupled = |power, scale, exponent| Warp::Coupled { to: "alpha".to_owned(), power, scale, exponent };
    let warps = [
        Warp::Linear,
        Warp::Power(0.5),
        Warp::Power(3.0),
        Warp::OneMinusPower(0.5),
        Warp::OneMinusPower(2.5),
        coupled(2.0, 1.0, 1.0),
        coupled(3.0, 3.0, 1.0),
        coupled(4.0, 1.0, 0.5),
        coupled(2.5, 16.0, 0.5),
    ];
    let alpha = 0.3;
    let mut compared = 0;
    for (id, domain) in
        [("mu", [0.0, 1.0]), ("mu", [0.125, 0.75]), ("eta", [1.5, 4.0]), ("curvature", [0.0, 2.0])]
    {
        for warp in &warps {
            for texel in [Texel::Center, Texel::Endpoint] {
                for direction in [Direction::Ascending, Direction::Descending] {
                    for offset in [0.0, 1.0, -1.0, 0.25, -0.375] {
                        let quantity = Quantity::find(id).unwrap();
                        let mut axis = Axis::new(quantity, 9, texel).over(domain).warped(warp.clone());
                        (axis.direction, axis.offset) = (direction, offset);
                        axis.check().unwrap();
                        let formula = axis.coordinate_formula();
                        // rows that an offset pushes beyond the end hold the value of the end
                        for i in 2..7 {
                            let value = axis.value(i, alpha);
                            let got = evaluate(&formula, &[(id, value), ("alpha", alpha)]);
                            let wanted = (i as f64 + 0.5) / 9.0;
                            assert!(
                                (got - wanted).abs() < 1e-9,
                                "{formula} at {id} = {value}: {got}, not {wanted}"
                            );
                            compared += 1;
                        }
                    }
                }
            }
        }
    }
    assert_eq!(compared, 4 * 9 * 2 * 2 * 5 * 5);
}

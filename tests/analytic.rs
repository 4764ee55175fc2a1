//! Formulas for split sums: errors as stated, at values from elsewhere, and code that parses.
#![allow(clippy::unwrap_used, clippy::print_stderr, clippy::cast_possible_truncation, reason = "test")]

use brdfbake::report::analytic::{Fit, Lang, Variables, fit};
use brdfbake::tables::spec::Request;

fn ggx(degree: usize, variables: Variables) -> Fit {
    let request = Request { kind: "dfg".into(), layout: Some("factored".into()), ..Request::default() };
    fit(&request.bind().unwrap(), degree, variables).unwrap()
}

#[test]
fn values_from_elsewhere_are_within_the_stated_errors() {
    let fit = ggx(2, Variables::Coupled);
    // mu, roughness, scale and bias by two other quadratures
    for line in include_str!("values/dfg.csv").lines().filter(|l| !l.starts_with(['#', 'm'])) {
        let row: Vec<f64> = line.split(',').map(|c| c.parse().unwrap()).collect();
        let alpha = row[1] * row[1];
        let got = fit.evaluate(row[0] as f32, alpha as f32).map(f64::from);
        let practical = row[0] >= 0.05 && row[1] >= 0.09;
        let bound = if practical { fit.practical.largest } else { fit.whole.largest };
        for (g, w) in got.iter().zip([row[2], row[3], row[2] + row[3]]) {
            // the stated error is the largest of a finite set of points; between them it may rise a little
            assert!((g - w).abs() <= 1.1 * bound, "{line}: {got:?}, stated {bound}");
            assert!((0.0..=1.0).contains(g), "{line}: {got:?}");
        }
    }
}

#[test]
fn wgsl_and_glsl_parse() {
    let fit = ggx(2, Variables::Coupled);
    naga::front::wgsl::parse_str(&fit.code(Lang::Wgsl)).unwrap();
    let glsl = format!("#version 450\n{}\nvoid main() {{ split_sum(0.5, 0.5); }}\n", fit.code(Lang::Glsl));
    let options = naga::front::glsl::Options::from(naga::ShaderStage::Fragment);
    naga::front::glsl::Frontend::default().parse(&options, &glsl).unwrap();
}

#[test]
#[ignore = "prints the table of README"]
fn table_of_degrees() {
    for variables in [Variables::Coupled, Variables::Plain] {
        for degree in 1..=4 {
            let request =
                Request { kind: "dfg".into(), layout: Some("factored".into()), ..Request::default() };
            let fit = match fit(&request.bind().unwrap(), degree, variables) {
                Ok(fit) => fit,
                Err(e) => {
                    eprintln!("{variables:?} {degree}: {e}");
                    continue;
                }
            };
            eprintln!("{variables:?} {degree}: {} operations", fit.operations());
            eprintln!("  whole {:?}\n  practical {:?}", fit.whole, fit.practical);
        }
    }
}

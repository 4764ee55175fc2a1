//! `brdfbake fit` as it is typed.

use std::process::{Command, Output};

fn fit(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_brdfbake")).arg("fit").args(arguments).output().unwrap()
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).unwrap()
}

#[test]
fn a_recipe_a_kind_and_a_model_are_fitted() {
    let cases: [(&[&str], &str); 4] = [
        (&["--degree", "1"], "vec3 split_sum(float mu, float alpha)"),
        (
            &["-r", "split-sum", "-t", "dfg-scale-bias", "--degree", "1"],
            "vec3 split_sum(float mu, float alpha)",
        ),
        (
            &["-t", "average-albedo", "--form", "polynomial", "--error", "0.01", "--lang", "rust"],
            "pub fn average_albedo_fit(",
        ),
        (&["beckmann", "-t", "albedo", "--layout", "e", "--degree", "1", "--lang", "c"], "void albedo_fit("),
    ];
    for (arguments, signature) in cases {
        let output = fit(arguments);
        let code = text(&output.stdout);
        assert!(output.status.success(), "{arguments:?}: {}", text(&output.stderr));
        assert!(code.contains(signature), "{arguments:?}: {code}");
        assert!(code.starts_with("//") && code.contains("whole domain: largest"), "{code}");
    }
}

#[test]
fn what_cannot_be_is_said() {
    let cases: [(&[&str], i32, &str); 8] = [
        (&["--degree", "9"], 2, "--degree 9 outside 1 to 5"),
        (&["--error", "0"], 2, "--error 0 must be a positive number"),
        (
            &["--error", "1e-9"],
            4,
            "no degree up to 5 is within 1e-9 over the practical domain; the best reached",
        ),
        (&["-r", "split-sum", "-t", "nothing"], 3, "split-sum: no table `nothing`; there is"),
        (&["-t", "nothing"], 3, "no table `nothing`"),
        (&["lambert"], 3, "Fresnel factor that cannot be split off"),
        (&["-t", "merl"], 3, "merl"),
        (&["-r", "split-sum", "ggx"], 2, "cannot be used with"),
    ];
    for (arguments, exit, message) in cases {
        let output = fit(arguments);
        let said = text(&output.stderr);
        assert_eq!(output.status.code(), Some(exit), "{arguments:?}: {said}");
        assert!(said.contains(message), "{arguments:?}: {said}");
    }
}

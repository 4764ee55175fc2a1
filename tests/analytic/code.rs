//! Code of formulas: compiled and run where its compiler is there, parsed and validated by `naga`.

use crate::analytic::split::GGX;
use crate::tolerance::{SHADER_SINGLE, near};
use crate::{analytic::split, common};
use brdfbake::report::analytic::{FittedFormula, Form, Lang, table};
use naga::front::{glsl, wgsl};
use naga::valid::{Capabilities, ValidationFlags, Validator};
use std::path::PathBuf;
use std::process::Command;

/// A split sum, and a table with every kind of step: a coupled axis, two channels of another range than [0, 1].
fn fits() -> Vec<FittedFormula> {
    use brdfbake::grid::{Texel::Endpoint, Warp};
    let coupled = Warp::Coupled { to: "alpha".into(), power: 3.0, scale: 2.0, exponent: 1.0 };
    let axes = vec![
        common::axis("mu", 8, Endpoint).warped(coupled),
        common::axis("roughness", 8, Endpoint).warped(Warp::Power(0.5)),
    ];
    let bound = common::request("dfg", "factored", "{}", axes);
    vec![GGX.clone(), table(&bound, Form::Rational, 2).unwrap(), table(&bound, Form::Polynomial, 3).unwrap()]
}

fn name(fit: &FittedFormula) -> &'static str {
    if fit.arguments()[1] == "alpha" { "split_sum" } else { "dfg_fit" }
}

fn points() -> Vec<[f32; 2]> {
    let mut points = vec![[0.0, 1.0], [1.0, 0.0], [1.0, 1.0], [1e-6, 1e-6], [0.05, 0.0081]];
    points.extend((0..200).map(|i| [3, 7].map(|n| ((i * n) as f32 * 0.618_034).fract())));
    points
}

fn folder(name: &str) -> PathBuf {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(format!("analytic-{name}"));
    std::fs::create_dir_all(&folder).unwrap();
    folder
}

/// What a command prints; none if there is no such program.
fn run(command: &mut Command) -> Option<String> {
    let output = match command.output() {
        Err(e) if e.kind() == std::io::ErrorKind::NotFound => {
            eprintln!("SKIPPED: {} is not there", command.get_program().display());
            return None;
        }
        output => output.unwrap(),
    };
    assert!(output.status.success(), "{command:?}: {}", String::from_utf8_lossy(&output.stderr));
    Some(String::from_utf8(output.stdout).unwrap())
}

/// The numbers that a program printed, one point a line, are those that the library computes.
fn compare(what: &str, fit: &FittedFormula, printed: &str) {
    assert_eq!(printed.lines().count(), points().len());
    for (line, at) in printed.lines().zip(points()) {
        let want = fit.evaluate(&at);
        let got: Vec<f32> = line.split_whitespace().map(|n| n.parse().unwrap()).collect();
        assert_eq!(got.len(), want.len());
        for (g, w) in got.iter().zip(&want) {
            // powers differ in the last bits from one library to the next
            near!(f64::from(*g), f64::from(*w), SHADER_SINGLE, "{what} at {at:?}: {got:?}, {want:?}");
        }
    }
}

fn calls(call: impl Fn(&str) -> String) -> String {
    points().iter().map(|[a, b]| call(&format!("{a:?}, {b:?}"))).collect()
}

#[test]
fn c_computes_the_same() {
    let folder = folder("c");
    for (i, fit) in fits().iter().enumerate() {
        let n = fit.results.len();
        let print = format!("for (int c = 0; c < {n}; c++) printf(\"%.9g \", (double)out[c]); puts(\"\");");
        let body = calls(|a| {
            let a = a.replace(", ", "f, ");
            format!("    {}({a}f, out); {print}\n", name(fit))
        });
        let source = format!(
            "#include <stdio.h>\n{}\nint main(void) {{\n    float out[{n}];\n{body}    return 0;\n}}\n",
            fit.code(Lang::C)
        );
        let (file, program) = (folder.join(format!("main{i}.c")), folder.join(format!("main{i}.exe")));
        std::fs::write(&file, source).unwrap();
        let flags = ["-std=c99", "-Wall", "-Wextra", "-Wdouble-promotion", "-Werror", "-O1"];
        if run(Command::new("cc").args(flags).arg(&file).arg("-o").arg(&program).arg("-lm")).is_none() {
            return;
        }
        compare("c", fit, &run(&mut Command::new(&program)).unwrap());
    }
}

#[test]
fn rust_computes_the_same() {
    let folder = folder("rust");
    let rustc = std::env::var_os("RUSTC").unwrap_or("rustc".into());
    for (i, fit) in fits().iter().enumerate() {
        let body =
            calls(|a| format!("    for v in {}({a}) {{ print!(\"{{v:?}} \"); }} println!();\n", name(fit)));
        let (file, program) = (folder.join(format!("main{i}.rs")), folder.join(format!("main{i}.exe")));
        std::fs::write(&file, format!("{}\nfn main() {{\n{body}}}\n", fit.code(Lang::Rust))).unwrap();
        let flags = ["--edition", "2021", "-D", "warnings", "-C", "debuginfo=0", "--crate-name", "formula"];
        if run(Command::new(&rustc).args(flags).arg(&file).arg("-o").arg(&program)).is_none() {
            return;
        }
        compare("rust", fit, &run(&mut Command::new(&program)).unwrap());
    }
}

/// In arrays of 32 bits, in which NumPy computes as the shader does.
#[test]
fn python_computes_the_same() {
    let program = std::env::var_os("BRDFBAKE_PYTHON").unwrap_or("python3".into());
    if !Command::new(&program).args(["-c", "import numpy"]).output().is_ok_and(|o| o.status.success()) {
        eprintln!("SKIPPED: no {} with NumPy", program.display());
        return;
    }
    let folder = folder("python");
    for (i, fit) in fits().iter().enumerate() {
        let at: Vec<String> = points().iter().map(|p| format!("{p:?}")).collect();
        let print = "print(*(repr(float(x)) for x in v))";
        let call = format!("{}(*np.array([{}], np.float32).T)", name(fit), at.join(", "));
        let file = folder.join(format!("main{i}.py"));
        std::fs::write(&file, format!("{}\nfor v in {call}:\n    {print}\n", fit.code(Lang::Python)))
            .unwrap();
        compare("python", fit, &run(Command::new(&program).arg(&file)).unwrap());
    }
}

fn validate(what: &str, module: &naga::Module, fit: &FittedFormula) {
    let mut validator = Validator::new(ValidationFlags::all(), Capabilities::default());
    validator.validate(module).unwrap_or_else(|e| panic!("{what}: {e:?}"));
    let (_, f) = module.functions.iter().find(|(_, f)| f.name.as_deref() == Some(name(fit))).unwrap();
    let size = match module.types[f.result.as_ref().unwrap().ty].inner {
        naga::TypeInner::Vector { size, .. } => size as usize,
        ref other => panic!("{what}: {other:?}"),
    };
    assert_eq!(size, fit.results.len(), "{what}");
}

#[test]
fn shaders_are_valid() {
    for fit in fits() {
        let source = fit.code(Lang::Wgsl);
        let module = wgsl::parse_str(&source).unwrap_or_else(|e| panic!("{}", e.emit_to_string(&source)));
        validate("wgsl", &module, &fit);
        let source = format!("#version 450\n{}\nvoid main() {{}}\n", fit.code(Lang::Glsl));
        let options = glsl::Options::from(naga::ShaderStage::Fragment);
        validate("glsl", &glsl::Frontend::default().parse(&options, &source).unwrap(), &fit);
        // no validator of HLSL installs from a registry; what can be said is that its function is that of GLSL
        let hlsl = fit
            .code(Lang::Hlsl)
            .replace("float2", "vec2")
            .replace("float3", "vec3")
            .replace("float4", "vec4");
        assert_eq!(hlsl, fit.code(Lang::Glsl));
    }
}

#[test]
fn the_code_says_what_it_is_and_how_far_off() {
    let fit = split::fit("ggx", 1).unwrap();
    let code = fit.code(Lang::Glsl);
    for part in [
        "// Split sum of ggx".to_owned(),
        format!("{} operations", fit.operations()),
        format!("// whole domain: largest {:.2e}", fit.whole.largest),
        format!("// mu >= 0.05, roughness >= 0.09: largest {:.2e}", fit.largest(true)),
    ] {
        assert!(code.contains(&part), "{part} is not in\n{code}");
    }
}

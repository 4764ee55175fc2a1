//! Code, compiled and run against the reference lookup where its compiler is there, and parsed by `naga`.

use super::support::written;
use brdfbake::encode::{ENCODERS, Storage, quantise_table};
use brdfbake::grid::{Axis, Channel, Direction, Grid, Quantity, Table, Texel, Warp, lookup};
use naga::front::{glsl, wgsl};
use naga::valid::{Capabilities, ValidationFlags, Validator};
use std::path::{Path, PathBuf};
use std::process::Command;

fn axis(id: &str, len: usize, texel: Texel) -> Axis {
    Axis::new(Quantity::find(id).unwrap(), len, texel)
}

fn coupled(to: &str, power: f64, scale: f64, exponent: f64) -> Warp {
    Warp::Coupled { to: to.into(), power, scale, exponent }
}

/// Grids with every warp, texel convention, direction, and derived quantity.
pub(crate) fn grids() -> Vec<Vec<Axis>> {
    use Texel::{Center, Endpoint};
    let turned = |a: Axis| Axis { direction: Direction::Descending, ..a };
    vec![
        vec![axis("mu", 9, Center)],
        vec![
            axis("mu", 7, Center).warped(Warp::Power(0.5)),
            Axis { offset: 1.0, ..axis("roughness", 5, Center) },
        ],
        vec![
            axis("mu", 7, Endpoint).warped(coupled("alpha", 2.0, 1.0, 1.0)),
            axis("roughness", 6, Endpoint).over([0.05, 0.9]),
        ],
        vec![
            turned(axis("mu", 7, Endpoint).warped(Warp::OneMinusPower(0.5))),
            axis("alpha", 5, Center).warped(Warp::Power(0.3)),
        ],
        vec![
            axis("alpha", 4, Endpoint).warped(coupled("mu", 1.5, 0.7, 0.5)),
            axis("theta", 5, Endpoint),
            axis("f0_root4", 3, Center).warped(Warp::Power(2.0)),
        ],
        vec![
            axis("mu", 3, Center).warped(coupled("eta", 2.0, 1.0, 1.0)),
            axis("f0_root4", 4, Endpoint),
            axis("phi", 3, Endpoint),
            axis("m", 3, Center).warped(Warp::Power(4.0)),
        ],
    ]
}

/// A table with values that have no pattern, some of them negative, large or tiny.
pub(crate) fn table(axes: Vec<Axis>, channels: usize) -> Table {
    let grid = Grid::new(axes).unwrap();
    let n = grid.len() * channels;
    let x = |i: usize| (i as f64 * 0.618_033_988_749_895 + 0.1).fract() - 0.3;
    Table {
        channels: (0..channels)
            .map(|c| Channel {
                id: format!("v{c}"),
                meaning: "∫ f µ dω".into(),
                range: [-1.0, 1.0],
                role: String::new(),
            })
            .collect(),
        values: (0..n).map(|i| if i % 17 == 3 { 1e-9 } else { x(i) }).collect(),
        errors: vec![0.0; n],
        evaluations: vec![1; grid.len()],
        grid,
    }
}

/// Points inside, on the ends and beyond them, in the quantities of the axes, and what the reference reads there.
pub(crate) fn points(t: &Table, storage: Storage) -> Vec<(Vec<f64>, Vec<f64>)> {
    let values = quantise_table(t, storage).unwrap().values;
    let mut points = Vec::new();
    for i in 0..60 {
        let at: Vec<f64> = t
            .grid
            .axes()
            .iter()
            .enumerate()
            .map(|(n, a)| {
                let x = ((i * (n + 2)) as f64 * 0.754_877_666_246_692_8 + 0.05).fract();
                let [lo, hi] = a.domain;
                match (i + n) % 11 {
                    0 => lo,
                    1 => hi,
                    _ => lo + (hi - lo) * x,
                }
            })
            .map(|v| f64::from(v as f32))
            .zip(t.grid.axes())
            .map(|(v, a)| v.clamp(a.domain[0], a.domain[1]))
            .collect();
        let base: Vec<f64> = at.iter().zip(t.grid.axes()).map(|(v, a)| a.quantity.to_base(*v)).collect();
        let mut out = vec![0.0; t.channels.len()];
        lookup::read(&t.grid, &values, &t.grid.point(&base).unwrap(), &mut out);
        points.push((at, out));
    }
    points
}

pub(crate) fn folder(name: &str) -> PathBuf {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(format!("code-{name}"));
    std::fs::create_dir_all(&folder).unwrap();
    folder
}

/// Runs a command; none if there is no such program.
pub(crate) fn run(command: &mut Command) -> Option<String> {
    let output = match command.output() {
        Err(e) if e.kind() == std::io::ErrorKind::NotFound => {
            eprintln!("skipped: {} is not there", command.get_program().display());
            return None;
        }
        output => output.unwrap(),
    };
    let text = |b: Vec<u8>| String::from_utf8_lossy(&b).into_owned();
    assert!(output.status.success(), "{command:?}: {}", text(output.stderr));
    Some(text(output.stdout))
}

/// One line a point.
fn compare(what: &str, printed: &str, points: &[(Vec<f64>, Vec<f64>)], tolerance: f64) {
    let lines: Vec<&str> = printed.lines().collect();
    assert_eq!(lines.len(), points.len(), "{what}");
    for (line, (at, want)) in lines.iter().zip(points) {
        let got: Vec<f64> = line.split_whitespace().map(|n| n.parse().unwrap()).collect();
        assert_eq!(got.len(), want.len());
        for (g, w) in got.iter().zip(want) {
            assert!((g - w).abs() <= tolerance, "{what} at {at:?}: got {g}, expected {w}");
        }
    }
}

/// Every table in a language: its source, the calls, what they must print, and how near.
fn programs(container: &str) -> Vec<(String, Table, Vec<(Vec<f64>, Vec<f64>)>, f64)> {
    let mut programs = Vec::new();
    for (i, axes) in grids().into_iter().enumerate() {
        // an index of a few texels is wrong by some 1e-6 of a texel in f32
        let (storage, tolerance) = if i % 2 == 0 { (Storage::Float, 2e-5) } else { (Storage::Double, 2e-13) };
        let t = table(axes, 1 + i % 3);
        let (bytes, _) = written(&t, container, storage, &[]).unwrap();
        let expected = points(&t, storage);
        programs.push((String::from_utf8(bytes).unwrap(), t, expected, tolerance));
    }
    programs
}

fn calls(points: &[(Vec<f64>, Vec<f64>)], call: impl Fn(&str) -> String) -> String {
    let arguments = |at: &[f64]| at.iter().map(|v| format!("{v:?}")).collect::<Vec<_>>().join(", ");
    points.iter().map(|(at, _)| call(&arguments(at))).collect()
}

#[test]
fn c_reads_as_the_reference() {
    let folder = folder("c");
    for (i, (source, t, expected, tolerance)) in programs("c").into_iter().enumerate() {
        let n = t.channels.len();
        let kind = if i % 2 == 0 { "float" } else { "double" };
        let print = "for (int c = 0; c < N; c++) printf(\"%.17g \", (double)out[c]); puts(\"\");";
        let body = calls(&expected, |a| format!("dfg_lookup({a}, out); {print}\n"));
        let main = format!(
            "#include <stdio.h>\n#include \"table{i}.h\"\n#define N {n}\nint main(void) {{ {kind} out[N];\n{body}return 0; }}\n"
        );
        std::fs::write(folder.join(format!("table{i}.h")), source).unwrap();
        let (file, program) = (folder.join(format!("main{i}.c")), folder.join(format!("main{i}.exe")));
        std::fs::write(&file, main).unwrap();
        let flags = ["-std=c99", "-Wall", "-Wextra", "-Werror", "-O1"];
        let mut cc = Command::new("cc");
        if run(cc.args(flags).arg(&file).arg("-o").arg(&program).arg("-lm")).is_none() {
            return;
        }
        compare(&format!("c {i}"), &run(&mut Command::new(&program)).unwrap(), &expected, tolerance);
    }
}

#[test]
fn cpp_reads_as_the_reference() {
    let folder = folder("cpp");
    for (i, (source, _, expected, tolerance)) in programs("cpp").into_iter().enumerate() {
        let f = if i % 2 == 0 { "static_cast<float>" } else { "" };
        let arguments = |a: &str| a.split(", ").map(|a| format!("{f}({a})")).collect::<Vec<_>>().join(", ");
        let print = "{ std::printf(\"%.17g \", static_cast<double>(v)); } std::puts(\"\");";
        let body = calls(&expected, |a| format!("for (auto v : dfg_lookup({})) {print}\n", arguments(a)));
        let main = format!("#include <cstdio>\n#include \"table{i}.hpp\"\nint main() {{\n{body}}}\n");
        std::fs::write(folder.join(format!("table{i}.hpp")), source).unwrap();
        let (file, program) = (folder.join(format!("main{i}.cpp")), folder.join(format!("main{i}.exe")));
        std::fs::write(&file, main).unwrap();
        let flags = ["-std=c++17", "-Wall", "-Wextra", "-Wconversion", "-Werror", "-O0"];
        if run(Command::new("c++").args(flags).arg(&file).arg("-o").arg(&program)).is_none() {
            return;
        }
        let printed = run(&mut Command::new(&program)).unwrap();
        compare(&format!("cpp {i}"), &printed, &expected, tolerance);
    }
}

#[test]
fn rust_reads_as_the_reference() {
    let folder = folder("rust");
    let rustc = std::env::var_os("RUSTC").unwrap_or("rustc".into());
    for (i, (source, _, expected, tolerance)) in programs("rust").into_iter().enumerate() {
        let print = "for v in out { print!(\"{v:?} \"); } println!();";
        let body = calls(&expected, |a| format!("let out = dfg_lookup({a}); {print}\n"));
        let (file, program) = (folder.join(format!("main{i}.rs")), folder.join(format!("main{i}.exe")));
        std::fs::write(&file, format!("{source}\nfn main() {{\n{body}}}\n")).unwrap();
        let flags = ["--edition", "2021", "-D", "warnings", "-C", "debuginfo=0", "--crate-name", "table"];
        if run(Command::new(&rustc).args(flags).arg(&file).arg("-o").arg(&program)).is_none() {
            return;
        }
        let printed = run(&mut Command::new(&program)).unwrap();
        compare(&format!("rust {i}"), &printed, &expected, tolerance);
    }
}

#[test]
fn javascript_reads_as_the_reference() {
    let folder = folder("js");
    for (i, (source, _, expected, tolerance)) in programs("js").into_iter().enumerate() {
        let body = calls(&expected, |a| format!("console.log(dfg_lookup({a}).join(' '));\n"));
        let file = folder.join(format!("main{i}.mjs"));
        std::fs::write(&file, format!("{source}\n{body}")).unwrap();
        let Some(printed) = run(Command::new("node").arg(&file)) else { return };
        compare(&format!("js {i}"), &printed, &expected, tolerance);
    }
}

/// A Python with NumPy: what `BRDFBAKE_PYTHON` names, or `python3`; none if there is none.
pub(crate) fn python() -> Option<Command> {
    let program = std::env::var_os("BRDFBAKE_PYTHON").unwrap_or("python3".into());
    let found =
        Command::new(&program).args(["-c", "import numpy"]).output().is_ok_and(|o| o.status.success());
    if !found {
        eprintln!("skipped: no {} with NumPy", program.display());
    }
    found.then(|| Command::new(program))
}

/// One number a time, and all in one call; with warnings as errors, so that nothing is computed out of range.
#[test]
fn python_reads_as_the_reference() {
    let Some(mut python) = python() else { return };
    let (folder, programs) = (folder("python"), programs("python"));
    let mut main = String::from("import warnings\nwarnings.simplefilter('error')\nimport numpy as np\n");
    for (i, (source, t, expected, _)) in programs.iter().enumerate() {
        std::fs::write(folder.join(format!("table{i}.py")), source).unwrap();
        main += &format!("from table{i} import dfg_lookup\n");
        main += &calls(expected, |a| {
            format!("print(*(repr(float(v)) for v in dfg_lookup({a}).astype(np.float64)))\n")
        });
        let at: Vec<&Vec<f64>> = expected.iter().map(|e| &e.0).collect();
        let axes = t.grid.axes().len();
        main += &format!(
            "for v in dfg_lookup(*np.array({at:?}).T):\n    print(*(repr(float(x)) for x in v))\n\
             assert dfg_lookup(*[np.zeros((3, 1)) + a.min() for a in np.array({at:?}).T]).shape == (3, 1, {n})\n\
             with np.errstate(invalid='ignore'):\n    assert np.isnan(dfg_lookup(*[np.nan] * {axes})).all()\n",
            n = t.channels.len(),
        );
    }
    let file = folder.join("main.py");
    std::fs::write(&file, main).unwrap();
    let printed = run(python.arg(&file)).unwrap();
    let mut lines = printed.lines();
    for (i, (_, _, expected, tolerance)) in programs.iter().enumerate() {
        for way in ["one by one", "arrays"] {
            let lines: Vec<&str> = lines.by_ref().take(expected.len()).collect();
            compare(&format!("python {i}, {way}"), &lines.join("\n"), expected, *tolerance);
        }
    }
    assert!(lines.next().is_none());
}

fn validate(what: &str, module: &naga::Module, channels: usize) {
    let mut validator = Validator::new(ValidationFlags::all(), Capabilities::default());
    validator.validate(module).unwrap_or_else(|e| panic!("{what}: {e:?}"));
    let (_, f) = module.functions.iter().find(|(_, f)| f.name.as_deref() == Some("dfg_lookup")).unwrap();
    let size = match module.types[f.result.as_ref().unwrap().ty].inner {
        naga::TypeInner::Scalar(_) => 1,
        naga::TypeInner::Vector { size, .. } => size as usize,
        ref other => panic!("{what}: {other:?}"),
    };
    assert_eq!(size, channels, "{what}");
}

#[test]
fn shaders_are_valid() {
    for axes in grids() {
        for channels in 1..=4 {
            let t = table(axes.clone(), channels);
            let text =
                |container| String::from_utf8(written(&t, container, Storage::Half, &[]).unwrap().0).unwrap();
            let source = text("wgsl");
            let module = wgsl::parse_str(&source).unwrap_or_else(|e| panic!("{}", e.emit_to_string(&source)));
            validate("wgsl", &module, channels);
            let source = format!("#version 450\n{}\nvoid main() {{}}\n", text("glsl"));
            let options = glsl::Options::from(naga::ShaderStage::Fragment);
            let module = glsl::Frontend::default().parse(&options, &source).unwrap();
            validate("glsl", &module, channels);
            // no validator of HLSL installs from a registry; what can be said is that its function is that of GLSL
            let body =
                |s: &str| s.split("_lookup(").nth(1).and_then(|s| s.split_once('{')).unwrap().1.to_owned();
            let hlsl = body(&text("hlsl"))
                .replace("float2", "vec2")
                .replace("float3", "vec3")
                .replace("float4", "vec4");
            assert_eq!(hlsl, body(&text("glsl")));
        }
    }
}

#[test]
fn the_first_line_is_the_provenance() {
    let t = table(grids().remove(0), 1);
    for e in ENCODERS.iter().filter(|e| Path::new(e.extension()).as_os_str() != "csv" && e.holds_metadata()) {
        if !e.magic().is_empty() {
            continue;
        }
        let (bytes, _) = written(&t, e.id(), Storage::Half, &[]).unwrap();
        assert!(bytes.is_ascii());
        let text = String::from_utf8(bytes).unwrap();
        let mark = if e.id() == "python" { "#" } else { "//" };
        let json = text.lines().next().unwrap().strip_prefix(&format!("{mark} brdfbake ")).unwrap();
        let told: brdfbake::grid::Provenance = serde_json::from_str(json).unwrap();
        assert_eq!((told.name.as_str(), told.channels[0].meaning.as_str()), ("dfg", "∫ f µ dω"));
    }
}

/// A constant of a shader has at most 65 532 numbers; C has no such limit.
#[test]
fn shaders_refuse_arrays_that_no_front_end_takes() {
    for (len, fits) in [(16_383, true), (16_384, false)] {
        let t = table(vec![axis("mu", len, Texel::Endpoint), axis("alpha", 2, Texel::Endpoint)], 2);
        for lang in ["glsl", "wgsl", "hlsl"] {
            let got = written(&t, lang, Storage::Half, &[]);
            assert_eq!(got.is_ok(), fits, "{lang}, {len} texels");
            if let Err(e) = got {
                assert!(e.to_string().contains("65536 numbers in one constant, but at most 65532"), "{e}");
            }
        }
        assert!(written(&t, "c", Storage::Half, &[]).is_ok());
    }
}

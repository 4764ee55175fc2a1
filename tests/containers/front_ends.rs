//! Shader code in other front ends than `naga`: glslang for GLSL and HLSL, with the validator of SPIR-V behind it; and what
//! `tests/three/foreign.mjs` needs to run GLSL and WGSL in a browser.

use super::code::{folder, grids, points, run, table};
use super::support::written;
use brdfbake::encode::Storage;
use brdfbake::tables::TABLES;
use std::path::{Path, PathBuf};
use std::process::Command;

/// A fragment shader that calls a function, so that nothing of it is left out.
fn whole(lang: &str, name: &str, source: &str, arguments: usize, channels: usize) -> String {
    let arguments = ["a.x", "a.y", "a.z", "a.w"][..arguments].join(", ");
    let swizzle = &"xyzw"[..channels];
    match lang {
        "glsl" => format!(
            "#version 450\n{source}\nlayout(location = 0) in vec4 a;\nlayout(location = 0) out vec4 o;\n\
             void main() {{ o = vec4(0.0); o.{swizzle} = {name}({arguments}); }}\n"
        ),
        _ => format!(
            "{source}\nfloat4 main(float4 a : TEXCOORD0) : SV_Target {{ float4 o = 0.0; o.{swizzle} = {name}({arguments}); return o; }}\n"
        ),
    }
}

/// The command that compiles a fragment shader to SPIR-V.
fn glslang(file: &Path, lang: &str, binary: &Path) -> Command {
    let mut command = Command::new("glslangValidator");
    command.args(["-V", "-S", "frag", "-e", "main", "--quiet"]);
    if lang == "hlsl" {
        command.arg("-D");
    }
    command.arg("-o").arg(binary).arg(file);
    command
}

/// Compiles to SPIR-V and validates that; false if a program is not there.
fn compiles(file: &Path, lang: &str) -> bool {
    let binary = file.with_extension(format!("{lang}.spv"));
    run(&mut glslang(file, lang, &binary)).is_some() && run(Command::new("spirv-val").arg(&binary)).is_some()
}

#[test]
fn glslang_compiles_the_shaders_to_valid_spirv() {
    let folder = folder("glslang");
    for (i, axes) in grids().into_iter().enumerate() {
        for channels in 1..=4 {
            let t = table(axes.clone(), channels);
            for lang in ["glsl", "hlsl"] {
                let source = String::from_utf8(written(&t, lang, Storage::Half, &[]).unwrap().0).unwrap();
                let file = folder.join(format!("table{i}-{channels}.{lang}"));
                std::fs::write(&file, whole(lang, "dfg_lookup", &source, axes.len(), channels)).unwrap();
                if !compiles(&file, lang) {
                    return;
                }
            }
        }
    }
}

#[test]
fn glslang_finds_a_fault() {
    let folder = folder("glslang-fault");
    let t = table(grids().remove(1), 2);
    for lang in ["glsl", "hlsl"] {
        let source = String::from_utf8(written(&t, lang, Storage::Half, &[]).unwrap().0).unwrap();
        let file = folder.join(format!("fault.{lang}"));
        for (name, good) in [("dfg_lookup", true), ("dfg_look", false)] {
            std::fs::write(&file, whole(lang, name, &source, 2, 2)).unwrap();
            let Ok(output) = glslang(&file, lang, &file.with_extension("spv")).output() else {
                eprintln!("skipped: glslangValidator is not there");
                return;
            };
            assert_eq!(output.status.success(), good, "{lang}: {name}");
        }
    }
}

/// The fitted split sum: its last function is the one that a shader calls.
#[test]
fn glslang_compiles_the_fit() {
    let folder = folder("glslang-fit");
    for lang in ["glsl", "hlsl"] {
        let mut fit = Command::new(env!("CARGO_BIN_EXE_brdfbake"));
        let source = run(fit.args(["fit", "ggx", "--lang", lang])).unwrap();
        let head = |l: &&str| ["vec", "float"].iter().any(|t| l.starts_with(t)) && l.ends_with('{');
        let line = source.lines().rfind(head).unwrap();
        let (kind, call) = line.split_once(' ').unwrap();
        let channels = kind.trim_start_matches(char::is_alphabetic).parse().unwrap();
        let (name, arguments) = call.split_once('(').unwrap();
        let whole = whole(lang, name, &source, arguments.split(',').count(), channels);
        let file = folder.join(format!("fit.{lang}"));
        std::fs::write(&file, whole).unwrap();
        if !compiles(&file, lang) {
            return;
        }
    }
}

/// Bakes one kind of table as GLSL and HLSL; none if a shader cannot hold it.
fn shader_files(recipe: &str, folder: &Path) -> Option<Vec<PathBuf>> {
    let file = folder.join("recipe.toml");
    std::fs::write(&file, recipe).unwrap();
    let mut bake = Command::new(env!("CARGO_BIN_EXE_brdfbake"));
    let output = bake.arg("bake").arg(&file).arg("-o").arg(folder).arg("--quiet").output().unwrap();
    if !output.status.success() {
        let told = String::from_utf8_lossy(&output.stderr).into_owned();
        let refused = told.contains("channels") || told.contains("numbers in one constant");
        assert!(refused, "{recipe}: {told}");
        return None;
    }
    let files = std::fs::read_dir(folder).unwrap().map(|e| e.unwrap().path());
    let shader = |p: &PathBuf| p.extension().is_some_and(|e| e == "glsl" || e == "hlsl");
    Some(files.filter(shader).collect())
}

/// Every kind of table that a shader can hold, on its own axes.
#[test]
#[ignore = "bakes every kind of table: some seconds"]
fn glslang_compiles_every_kind_of_table() {
    let (mut compiled, mut no_shader) = (Vec::new(), Vec::new());
    for kind in TABLES.iter().map(|t| t.id) {
        let folder = tempfile::tempdir().unwrap();
        // what is compiled is the code, not its numbers
        let recipe = format!(
            "name = \"one\"\n[[table]]\nkind = \"{kind}\"\nname = \"one\"\ntolerance = 1e-2\n\
             reconstruction = \"off\"\noutputs = [\"glsl:half\", \"hlsl:half\"]\n"
        );
        let Some(files) = shader_files(&recipe, folder.path()) else {
            no_shader.push(kind);
            continue;
        };
        let sources: Vec<String> = files.iter().map(|f| std::fs::read_to_string(f).unwrap()).collect();
        assert_eq!(files.len(), 2, "{kind}");
        for (path, source) in files.iter().zip(sources) {
            let lang = path.extension().and_then(|e| e.to_str()).unwrap();
            let (version, main) = match lang {
                "glsl" => ("#version 450\n", "void main() {}"),
                _ => ("", "float4 main() : SV_Target { return 0.0; }"),
            };
            std::fs::write(path, format!("{version}{source}\n{main}\n")).unwrap();
            if !compiles(path, lang) {
                return;
            }
        }
        compiled.push(kind);
    }
    eprintln!("compiled: {}; too many numbers or channels: {}", compiled.join(", "), no_shader.join(", "));
    assert!(compiled.len() >= 26, "{compiled:?}");
}

/// What the browser runs, and what it must read.
#[test]
#[ignore = "writes shaders for a browser: BRDFBAKE_FOREIGN=<folder>"]
fn write_shaders_for_a_browser() {
    let folder = std::env::var_os("BRDFBAKE_FOREIGN").unwrap_or(env!("CARGO_TARGET_TMPDIR").into());
    let mut programs = Vec::new();
    for (i, axes) in grids().into_iter().enumerate() {
        let channels = 1 + i % 4;
        let t = table(axes.clone(), channels);
        let text = |lang: &str| String::from_utf8(written(&t, lang, Storage::Half, &[]).unwrap().0).unwrap();
        let (at, want): (Vec<_>, Vec<_>) = points(&t, Storage::Half).into_iter().unzip();
        programs.push(
            serde_json::json!({"name": format!("table {i}"), "arguments": axes.len(), "channels": channels,
            "glsl": text("glsl"), "wgsl": text("wgsl"), "at": at, "want": want, "tolerance": 2e-5}),
        );
    }
    std::fs::create_dir_all(&folder).unwrap();
    let file = Path::new(&folder).join("shaders.json");
    std::fs::write(file, serde_json::to_string(&programs).unwrap()).unwrap();
}

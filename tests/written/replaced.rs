//! Files are replaced as a whole: whoever has the old one open, or another name for it, keeps the old one.

use brdfbake::cancel::Cancel;
use brdfbake::encode::atomic::write_all;
use brdfbake::pipeline::{self, Settings, Silent};
use brdfbake::recipe;
use std::fs::{self, File};
use std::io::Read;
use std::path::Path;

fn bake(f0: f64, out: &Path) {
    let recipe = format!(
        "name = 'x'\n[[table]]\nkind = 'fresnel-schlick'\nname = 'x'\nparams = {{ f0 = {f0:?} }}\noutputs = ['exr:float', 'npy:double']\n\
         [[table.axis]]\nid = 'mu'\nlength = 8\n"
    );
    let plan = recipe::parse(&recipe, "x.toml").unwrap();
    pipeline::run(&plan, &Settings::new(out), &Cancel::new(), &Silent).unwrap();
}

/// Another name, and an open file, of every file in a folder.
fn keep(out: &Path, kept: &Path) -> Vec<(String, Vec<u8>, File)> {
    fs::create_dir_all(kept).unwrap();
    let names = fs::read_dir(out).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap());
    let one = |name: String| {
        let path = out.join(&name);
        fs::hard_link(&path, kept.join(&name)).unwrap();
        let bytes = fs::read(&path).unwrap();
        (name, bytes, File::open(&path).unwrap())
    };
    names.map(one).collect()
}

fn unchanged(kept: &Path, all: Vec<(String, Vec<u8>, File)>, out: &Path) {
    assert!(!all.is_empty());
    for (name, bytes, mut open) in all {
        assert_eq!(fs::read(kept.join(&name)).unwrap(), bytes, "{name} was written over");
        let mut through = Vec::new();
        open.read_to_end(&mut through).unwrap();
        assert_eq!(through, bytes, "{name} was written over");
        assert_ne!(fs::read(out.join(&name)).unwrap(), bytes, "{name} was not replaced");
    }
}

#[test]
fn outputs_of_a_bake_are_replaced_not_written_over() {
    let dir = tempfile::tempdir().unwrap();
    let (out, kept) = (dir.path().join("out"), dir.path().join("kept"));
    bake(0.04, &out);
    let all = keep(&out, &kept);
    assert_eq!(all.len(), 3);
    bake(0.5, &out);
    unchanged(&kept, all, &out);
}

#[test]
fn single_files_are_replaced_not_written_over() {
    let dir = tempfile::tempdir().unwrap();
    let (out, kept) = (dir.path().join("out"), dir.path().join("kept"));
    let write = |text: &str| {
        write_all(&[(out.join("a"), text.into()), (out.join("b"), text.into())], &Cancel::new()).unwrap()
    };
    write("old");
    let all = keep(&out, &kept);
    write("new and longer");
    unchanged(&kept, all, &out);
}

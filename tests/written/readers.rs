//! A reader that knows nothing of an offset: what it gets is in the report of the file.

use brdfbake::cancel::Cancel;
use brdfbake::pipeline::{self, FileRecord, Settings, Silent};
use brdfbake::recipe;

const TEXELS: usize = 16;

/// Schlick's factor over mu, F0 = 0, bare of anything else.
fn baked(axis: &str) -> FileRecord {
    let recipe = format!(
        "name = 'x'\n[[table]]\nkind = 'fresnel-schlick'\nname = 'x'\nparams = {{ f0 = 0.0 }}\noutputs = ['exr:float']\n\
         [[table.axis]]\nid = 'mu'\nlength = {TEXELS}\ntexel = 'center'\n{axis}\n"
    );
    let plan = recipe::parse(&recipe, "x.toml").unwrap();
    let dir = tempfile::tempdir().unwrap();
    let outcome = pipeline::run(&plan, &Settings::new(dir.path()), &Cancel::new(), &Silent).unwrap();
    // the report is what the manifest says, as it is on the disk
    let text = std::fs::read_to_string(dir.path().join("manifest.json")).unwrap();
    let manifest: serde_json::Value = serde_json::from_str(&text).unwrap();
    let record = outcome.manifest.tables[0].files[0].clone();
    let told = &manifest["tables"][0]["files"][0]["as_read"];
    let largest = record.as_read.as_ref().map(|r| r.whole.largest.value);
    assert_eq!(told["whole"]["largest"]["value"].as_f64(), largest, "{told}");
    record
}

fn schlick(mu: f64) -> f64 {
    let m = 1.0 - mu;
    m * m * m * m * m
}

/// The largest and mean error of linear reading at mu of texels that hold the factor at `place(i)`.
fn errors(place: impl Fn(f64) -> f64) -> [f64; 2] {
    let (mut largest, mut sum) = (0.0f64, 0.0);
    let steps = 20_000;
    for k in 0..steps {
        let mu = (f64::from(k) + 0.5) / f64::from(steps);
        let x = (mu * TEXELS as f64 - 0.5).clamp(0.0, (TEXELS - 1) as f64);
        let low = x.floor();
        let texel = |i: f64| schlick(place(i.min((TEXELS - 1) as f64)).clamp(0.0, 1.0));
        let read = texel(low) * (1.0 - (x - low)) + texel(low + 1.0) * (x - low);
        let error = (read - schlick(mu)).abs();
        (largest, sum) = (largest.max(error), sum + error);
    }
    [largest, sum / f64::from(steps)]
}

#[test]
fn errors_are_told_as_an_engine_reads() {
    let n = TEXELS as f64;
    for offset in [1.0, -1.0, 0.5] {
        let record = baked(&format!("offset = {offset:?}"));
        let told = record.as_read.as_ref().unwrap();
        let [largest, mean] = errors(|i| (i + 0.5 + offset) / n);
        // the report looks at the middles of cells, and searches the worst more finely
        let ratio = told.whole.largest.value / largest;
        assert!((0.9..1.001).contains(&ratio), "offset {offset}: {:?} against {largest}", told.whole);
        assert!(
            (0.5..2.0).contains(&(told.whole.mean / mean)),
            "offset {offset}: {:?} against {mean}",
            told.whole
        );
        // who knows of the offset reads better, but at the end that no texel holds
        let known = record.reconstruction.as_ref().unwrap();
        assert!(known.whole.mean < 0.7 * told.whole.mean, "offset {offset}: {known:?}");
    }
    let plain = baked("");
    assert!(plain.as_read.is_none(), "there is nothing to tell apart");
    let [largest, _] = errors(|i| (i + 0.5) / n);
    let told = plain.reconstruction.unwrap().whole.largest.value;
    assert!((0.9..1.001).contains(&(told / largest)), "{told} against {largest}");
}

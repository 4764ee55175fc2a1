//! Files that do not say what they hold: the manifest beside them does.

use super::support::{brdfbake, code, err, folder, out, text, write};

const RECIPE: &str = r#"
name = "test"
[[table]]
kind = "dfg"
name = "small"
tolerance = 1e-4
outputs = ["raw:half", "dds:half", "npy:half", "exr:half", "exr:float+positional"]
[[table.axis]]
id = "mu"
length = 6
[[table.axis]]
id = "roughness"
length = 5
"#;

#[test]
fn a_file_without_metadata_is_known_by_the_manifest_beside_it() {
    let dir = folder();
    let recipe = write(dir.path(), "r.toml", &RECIPE.replace(", \"exr:float+positional\"", ""));
    let at = |name: &str| dir.path().join("out").join(name);
    let o = brdfbake(&["bake", text(&recipe), "-o", text(&dir.path().join("out"))]);
    assert_eq!(code(&o), 0, "{}", err(&o));
    for name in ["small.bin", "small.dds", "small.npy"] {
        let o = brdfbake(&["inspect", text(&at(name))]);
        assert_eq!(code(&o), 0, "{}", err(&o));
        assert!(out(&o).contains("dfg.scale") && out(&o).contains("manifest.json beside it"), "{}", out(&o));
        let o = brdfbake(&["diff", text(&at("small.exr")), text(&at(name))]);
        assert_eq!(code(&o), 0, "{}{}", out(&o), err(&o));
    }
    // bytes that are not those of the manifest are not what it says
    let mut bytes = std::fs::read(at("small.dds")).unwrap();
    *bytes.last_mut().unwrap() ^= 1;
    std::fs::write(at("small.dds"), bytes).unwrap();
    let o = brdfbake(&["inspect", text(&at("small.dds"))]);
    assert!(out(&o).contains("tells of other bytes") && !out(&o).contains("dfg.scale"), "{}", out(&o));
    // alone, the numbers must be told how to lie
    let alone = dir.path().join("alone.bin");
    std::fs::copy(at("small.bin"), &alone).unwrap();
    assert_eq!(code(&brdfbake(&["inspect", text(&alone)])), 3);
    let o = brdfbake(&["diff", text(&at("small.exr")), text(&alone), "--raw", "6x5x2:half"]);
    assert_eq!(code(&o), 0, "{}{}", out(&o), err(&o));
    assert!(out(&o).contains("compared dfg.scale = R, dfg.bias = G"), "{}", out(&o));
    for (args, part) in [
        (&["--raw", "6x5x2:half"][..], "no .bin file is given"),
        (&["--channels", "R"], "is not NAME=NAME"),
        (&["--channels", "R=a", "--by-position"], "cannot be used with"),
    ] {
        let o = brdfbake(&[&["diff", text(&at("small.exr")), text(&at("small.npy"))], args].concat());
        assert_eq!(code(&o), 2, "{}", err(&o));
        assert!(err(&o).contains(part), "{}", err(&o));
    }
}

#[test]
fn a_split_sum_of_unknown_convention_is_recognised() {
    let dir = folder();
    for (masking, axes, reversed) in
        [("correlated", ["mu", "roughness"], false), ("separable", ["roughness", "mu"], true)]
    {
        let direction = if reversed { "direction = \"descending\"\n" } else { "" };
        let recipe = format!(
            "name = \"t\"\n[[table]]\nkind = \"dfg\"\nname = \"t\"\ntolerance = 1e-4\nlayout = \"multiscatter\"\nparams = {{ masking = \"{masking}\" }}\n\
             outputs = [\"npy:float\"]\n[[table.axis]]\nid = \"{}\"\nlength = 24\ntexel = \"center\"\n[[table.axis]]\nid = \"{}\"\nlength = 20\n{direction}texel = \"endpoint\"\n",
            axes[0], axes[1]
        );
        let recipe = write(dir.path(), "r.toml", &recipe);
        let folder = dir.path().join(masking);
        let o = brdfbake(&["bake", text(&recipe), "-o", text(&folder)]);
        assert_eq!(code(&o), 0, "{}", err(&o));
        std::fs::remove_file(folder.join("manifest.json")).unwrap();
        let o = brdfbake(&["inspect", text(&folder.join("t.npy")), "--recognise", "--json"]);
        assert_eq!(code(&o), 0, "{}", err(&o));
        let found: serde_json::Value = serde_json::from_str(&out(&o)).unwrap();
        let best = &found["recognised"]["best"];
        assert_eq!(found["recognised"]["fits"], true, "{found}");
        assert_eq!(best["model"], format!("ggx masking = {masking}"));
        assert_eq!(best["channels"], serde_json::json!(["dfg.bias", "dfg.total"]));
        let along = if axes[0] == "mu" { "cosine" } else { "roughness" };
        assert_eq!(best["arrangement"]["x"], along);
        let rows = if axes[1] == "mu" { "mu_first" } else { "roughness_first" };
        assert_eq!(best["arrangement"][rows], if reversed { "high" } else { "low" });
        let texel = if axes[1] == "mu" { "mu_texel" } else { "roughness_texel" };
        assert_eq!(best["arrangement"][texel], "i / (n - 1)");
    }
}

//! Pages of people: what is in them, and what is not.

use super::support::{SMALL, brdfbake, code, err, folder, names, out, text, write};
use std::fs;
use std::path::Path;

/// A table with errors in its estimates, and one in a container that is not read.
const RECIPE: &str = r#"
name = "two"
[[table]]
kind = "dfg"
name = "dfg"
tolerance = 1e-3
outputs = ["exr:half", "csv:float"]
[[table.axis]]
id = "mu"
length = 8
[[table.axis]]
id = "roughness"
domain = [0.2, 1]
length = 6
[[table]]
kind = "fresnel-dielectric"
name = "bare"
outputs = ["raw:float"]
[[table.axis]]
id = "mu"
length = 8
[[table.axis]]
id = "eta"
domain = [1.2, 2]
length = 4
"#;

/// Two roundings to half below 1.
const ROUNDING: f64 = 1.0 / 1024.0;

fn bake(recipe: &Path, target: &Path, more: &[&str]) {
    let o = brdfbake(&[&["bake", text(recipe), "-q", "-o", text(target)], more].concat());
    assert_eq!(code(&o), 0, "{}", err(&o));
}

fn page(dir: &Path) -> String {
    fs::read_to_string(dir.join("report.html")).unwrap()
}

/// Rows of the table of the worst texels, as text.
fn worst(page: &str) -> Vec<String> {
    let from = page.find("Worst texels</h3>").unwrap();
    let body = &page[from..];
    let body = &body[body.find("<tbody>").unwrap()..body.find("</tbody>").unwrap()];
    let plain = |row: &str| {
        let mut text = String::new();
        let mut tag = false;
        for c in row.chars() {
            match c {
                '<' => tag = true,
                '>' => (tag, text) = (false, text + " "),
                _ if !tag => text.push(c),
                _ => {}
            }
        }
        text.split_whitespace().collect::<Vec<_>>().join(" ")
    };
    body.split("</tr>").map(plain).filter(|r| !r.is_empty()).collect()
}

#[test]
fn a_report_is_the_same_on_any_number_of_threads_and_belongs_to_its_folder() {
    let dir = folder();
    let recipe = write(dir.path(), "recipe.toml", RECIPE);
    let [one, two] = ["one", "two"].map(|n| dir.path().join(n));
    bake(&recipe, &one, &["--report", "--jobs", "1"]);
    bake(&recipe, &two, &["--report", "--jobs", "2"]);
    assert_eq!(page(&one), page(&two));
    assert!(!page(&one).contains("Timings"));
    let o = brdfbake(&["verify", text(&one)]);
    assert!(code(&o) == 0 && !out(&o).contains("report.html"), "{}", out(&o));
    // a bake without a report says that the page is not its own
    bake(&recipe, &one, &[]);
    assert!(fs::read_to_string(one.join("manifest.json")).unwrap().contains("\"report.html\""));
    bake(&recipe, &one, &["--report", "--timings"]);
    assert!(page(&one).contains("Timings"));
    assert!(!fs::read_to_string(one.join("manifest.json")).unwrap().contains("\"report.html\""));
}

#[test]
fn names_are_text() {
    let dir = folder();
    let evil = "</script><script>alert(1)</script><img src=x onerror=alert(2)>";
    let scene = serde_json::json!({
        "asset": { "version": "2.0" },
        "materials": [{ "name": evil, "pbrMetallicRoughness": { "roughnessFactor": 0.5, "metallicFactor": 1.0 } },
                      { "name": evil, "extensions": { "KHR_materials_unlit": {} } }],
        "extensionsUsed": ["KHR_materials_unlit"],
    });
    let scene = write(dir.path(), "scene.gltf", &scene.to_string());
    let target = dir.path().join("out");
    let o = brdfbake(&["bake", "--scene", text(&scene), "--report", "-q", "-o", text(&target)]);
    assert_eq!(code(&o), 0, "{}", err(&o));
    let page = page(&target);
    assert_eq!((page.matches("<script").count(), page.matches("</script").count()), (1, 1));
    assert!(!page.contains("<img src=x") && page.contains("&lt;/script&gt;&lt;script&gt;alert(1)"));
    assert!(page.contains("Left out") && page.contains("KHR_materials_unlit"));
    // a manifest is no more to be trusted than a scene
    let manifest = fs::read_to_string(target.join("manifest.json")).unwrap();
    let changed =
        manifest.replace("\"recipe\": \"scene\"", "\"recipe\": \"</title><script>alert(3)</script>\"");
    assert_ne!(changed, manifest);
    write(&target, "manifest.json", &changed);
    let o = brdfbake(&["report", text(&target), "--evaluations", "0"]);
    assert_eq!(code(&o), 0, "{}", err(&o));
    let page = self::page(&target);
    assert!(page.contains("<h1>Report of &lt;/title&gt;&lt;script&gt;"));
    assert_eq!((page.matches("<script").count(), page.matches("</title").count()), (1, 1));
}

#[test]
fn a_folder_is_integrated_anew_and_a_changed_number_is_the_worst() {
    let dir = folder();
    let recipe = write(dir.path(), "recipe.toml", RECIPE);
    let target = dir.path().join("out");
    bake(&recipe, &target, &["--report"]);
    let of_bake = page(&target);
    assert_eq!(worst(&of_bake).len(), 12);
    assert!(of_bake.contains("those of the bake"));
    let o = brdfbake(&["report", text(&target)]);
    assert_eq!(code(&o), 0, "{}", err(&o));
    let again = page(&target);
    assert!(again.contains("every texel was integrated anew"));
    assert!(again.contains("No picture: bare.bin: not a file of"), "a container without a reader is told");
    // the baker's own integrals, from what the file says of itself
    assert_eq!(worst(&again), worst(&of_bake));

    // mu = 5/7, roughness = 0.2 + 0.8 * 4/5, changed by 0.05 in the file
    let image = brdfbake::encode::read::read_file(&target.join("dfg.exr")).unwrap();
    let p = image.known().unwrap().clone();
    let grid = brdfbake::grid::Grid::new(p.axes.iter().map(|r| r.axis.clone()).collect()).unwrap();
    let n = p.channels.len();
    let mut values: Vec<f64> = (0..grid.len())
        .flat_map(|t| p.channels.iter().map(move |c| (t, c.id.clone())))
        .map(|(t, id)| image.channel(&id).unwrap().values[t])
        .collect();
    let texel = 5 + 8 * 4;
    values[n * texel] = half::f16::from_f64(values[n * texel] - 0.05).to_f64();
    let input = brdfbake::encode::EncodeInput {
        grid: &grid,
        channels: &p.channels,
        values: &values,
        blocks: &[],
        errors: &[],
        storage: brdfbake::encode::Storage::Half,
        options: &[],
        label: brdfbake::encode::Label { name: "dfg", identity: "", provenance_json: "{}" },
        cancel: &brdfbake::cancel::Cancel::new(),
    };
    let bytes = brdfbake::encode::encoder("exr").unwrap().encode(&input).unwrap();
    fs::write(target.join("dfg.exr"), bytes).unwrap();
    let other = dir.path().join("other");
    bake(&recipe, &other, &[]);
    let shown = dir.path().join("shown");
    let o = brdfbake(&["report", text(&target), "--against", text(&other), "-o", text(&shown), "-q"]);
    assert_eq!(code(&o), 0, "{}", err(&o));
    let page = page(&shown);
    let first = &worst(&page)[0];
    assert!(
        first.starts_with("dfg.scale 0.714286 0.84 ") && first.contains(" 5, 4 ") && first.contains(" 0.05"),
        "{first}"
    );
    assert!(page.contains("Against other"));
    let told = page.split("largest difference ").nth(1).unwrap();
    let largest: f64 = told.split_whitespace().next().unwrap().parse().unwrap();
    assert!((largest - 0.05).abs() < ROUNDING && told.contains("mu = 0.714286"), "{}", &told[..60]);

    // without integrals nothing is invented
    let o = brdfbake(&["report", text(&target), "--evaluations", "0", "-o", text(&shown), "-q"]);
    assert_eq!(code(&o), 0, "{}", err(&o));
    assert!(self::page(&shown).contains("No error of a texel is known."));
}

#[test]
fn a_large_bake_is_an_index_with_pages() {
    let dir = folder();
    let table = |name: &str| {
        format!(
            "[[table]]\nkind = \"fresnel-dielectric\"\nname = \"{name}\"\nreconstruction = \"off\"\noutputs = [\"exr:half\"]\n\
             [[table.axis]]\nid = \"mu\"\nlength = 256\n[[table.axis]]\nid = \"eta\"\ndomain = [1.2, 2]\nlength = 256\n"
        )
    };
    let recipe = format!("name = \"large\"\n{}", ["a", "b", "c"].map(table).concat());
    let recipe = write(dir.path(), "recipe.toml", &recipe);
    let target = dir.path().join("out");
    bake(&recipe, &target, &["--report"]);
    let pages: Vec<String> = names(&target).into_iter().filter(|n| n.ends_with(".html")).collect();
    assert_eq!(pages, ["report-1.html", "report-2.html", "report-3.html", "report.html"]);
    let index = page(&target);
    assert!(index.contains("href=\"report-3.html\"") && index.contains("alt=\"first channel of c\""));
    for name in pages {
        assert!(fs::metadata(target.join(name)).unwrap().len() < 2_000_000);
    }
}

#[test]
fn what_is_no_bake_is_refused() {
    let dir = folder();
    let o = brdfbake(&["report", text(dir.path())]);
    assert_eq!(code(&o), 3, "{}", err(&o));
    write(dir.path(), "manifest.json", r#"{"schema": 2, "maps": []}"#);
    let o = brdfbake(&["report", text(dir.path())]);
    assert!(code(&o) == 3 && err(&o).contains("is not the manifest of a bake of tables"), "{}", err(&o));
    // a manifest does not reach out of its folder
    let recipe = write(dir.path(), "recipe.toml", SMALL);
    let target = dir.path().join("out");
    bake(&recipe, &target, &[]);
    let manifest = fs::read_to_string(target.join("manifest.json")).unwrap();
    write(&target, "manifest.json", &manifest.replace("\"small.exr\"", "\"../out/small.exr\""));
    let o = brdfbake(&["report", text(&target)]);
    assert_eq!(code(&o), 0, "{}", err(&o));
    assert!(page(&target).contains("is not the name of a file in the folder"));
}

/// A table and a map of bumps, whose lobes are far from what they stand for.
const BOTH: &str = r#"
name = "both"
[[table]]
kind = "dfg"
name = "split"
tolerance = 1e-3
outputs = ["exr:half"]
[[table.axis]]
id = "mu"
length = 4
[[table.axis]]
id = "roughness"
domain = [0.2, 1]
length = 4
[[map]]
name = "bumps"
normal = "NORMAL"
roughness = 0.3
normals = "fit"
outputs = ["CONTAINER"]
"#;

#[test]
fn maps_are_shown_with_their_errors_and_worst_texels() {
    let dir = folder();
    let normal = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/scenes/bumps/normal.png");
    let mut said = Vec::new();
    for (name, container) in [("ktx2", "ktx2"), ("dds", "dds"), ("png", "png"), ("exr", "exr")] {
        let recipe = BOTH.replace("NORMAL", text(&normal)).replace("CONTAINER", container);
        let recipe = write(dir.path(), "recipe.toml", &recipe);
        let target = dir.path().join(name);
        bake(&recipe, &target, &["--report"]);
        let of_bake = page(&target);
        let o = brdfbake(&["report", text(&target), "-q"]);
        assert_eq!(code(&o), 0, "{}", err(&o));
        // the same section from the files alone
        let section = |page: &str| page[page.find("<h2>bumps</h2>").unwrap()..].to_owned();
        assert_eq!(section(&of_bake), section(&page(&target)), "{name}");
        let manifest: serde_json::Value =
            serde_json::from_slice(&fs::read(target.join("manifest.json")).unwrap()).unwrap();
        let worst = &manifest["maps"][0]["worst"][0];
        let told = format!("at level {}, texel ({}, {}): D = ", worst["level"], worst["x"], worst["y"]);
        assert!(of_bake.contains(&told), "{told}");
        assert!(
            of_bake.contains("alt=\"error: distance, level 0")
                || of_bake.contains("error: distance: 0 everywhere")
        );
        let level = format!("alt=\"error: distance, level {}: from ", worst["level"]);
        assert!(of_bake.contains(&level), "{name}");
        said.push(of_bake.split(&told).nth(1).unwrap()[..6].to_owned());
    }
    // whatever the container
    assert!(said.iter().all(|s| *s == said[0]), "{said:?}");
}

#[test]
fn error_against_evaluations_is_drawn_and_against_time_only_if_asked() {
    let dir = folder();
    let recipe = write(dir.path(), "recipe.toml", RECIPE);
    let target = dir.path().join("out");
    bake(&recipe, &target, &["--report"]);
    let plain = page(&target);
    assert!(plain.contains("error against evaluations; curves: this baker, to a tolerance;"));
    assert!(plain.contains("Error against evaluations is not drawn: "), "that of a Fresnel factor");
    assert!(!plain.contains("error against time"));
    let o = brdfbake(&["report", text(&target), "--timings", "-q"]);
    assert_eq!(code(&o), 0, "{}", err(&o));
    assert!(
        page(&target).contains("error against time; curves:") && page(&target).contains("<h2>Timings</h2>")
    );
    let o = brdfbake(&["report", text(&target), "--timings", "--evaluations", "0"]);
    assert_eq!(code(&o), 2, "{}", err(&o));
}

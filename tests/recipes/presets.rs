//! The presets are the files of `presets/`; each parses, binds and is named as its file.

use brdfbake::cancel::Cancel;
use brdfbake::recipe::{PRESETS, preset};
use brdfbake::tables::driver::{Options, bake};
use brdfbake::verify::reconstruction::Probe;
use std::collections::BTreeSet;
use std::path::Path;

#[test]
fn presets_are_the_files_of_the_folder() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("presets");
    let files: BTreeSet<String> = std::fs::read_dir(&folder)
        .unwrap()
        .map(|f| f.unwrap())
        .filter(|f| f.file_type().unwrap().is_file())
        .map(|f| f.file_name().into_string().unwrap())
        .collect();
    let listed: BTreeSet<String> = PRESETS.iter().map(|p| format!("{}.toml", p.id)).collect();
    assert_eq!(files, listed);
    for p in PRESETS {
        assert_eq!(std::fs::read_to_string(folder.join(format!("{}.toml", p.id))).unwrap(), p.source);
    }
}

#[test]
fn every_preset_resolves() {
    for p in PRESETS {
        let plan = p.plan().unwrap_or_else(|e| panic!("{e}"));
        assert_eq!(plan.name, p.id);
        assert!(plan.tables.iter().all(|t| t.asked.waivers.is_empty()), "{}: a preset breaks no law", p.id);
        assert!(p.source.starts_with("# "), "{}: the first line says who needs it", p.id);
    }
    assert_eq!(PRESETS[0].id, "default");
    assert!(preset("default").is_some() && preset("nothing").is_none());
}

/// The file of an index lies beside the recipe, and its rows are in the plan.
#[test]
fn an_index_is_read_from_a_file() {
    let folder = tempfile::tempdir().unwrap();
    let recipe = |file: &str| {
        let text = format!(
            "name = 'x'\n[[table]]\nkind = 'fresnel-conductor'\nname = 'x'\nlayout = 'srgb'\nparams = {{ metal = 'rows', nk = '{file}' }}\n"
        );
        let path = folder.path().join("recipe.toml");
        std::fs::write(&path, text).unwrap();
        brdfbake::recipe::load(&path).map_err(|e| e.to_string())
    };
    let write = |file: &str, text: &str| std::fs::write(folder.path().join(file), text).unwrap();
    write(
        "au.csv",
        "wl,n\n0.3542,1.5\n0.5486,0.43\n0.892,0.17\n\nwl,k\n0.3542,1.866\n0.5486,2.455\n0.892,5.663\n",
    );
    write(
        "au.yml",
        "DATA:\n  - type: tabulated nk\n    data: |\n        0.3542 1.5 1.866\n        0.5486 0.43 2.455\n        0.892 0.17 5.663\n",
    );
    write("glass.yml", "DATA:\n  - type: formula 2\n    coefficients: 0 1 2\n");
    let [csv, yaml] = ["au.csv", "au.yml"].map(|f| recipe(f).unwrap().tables[0].canonical());
    assert_eq!(csv, yaml);
    let why = recipe("glass.yml").unwrap_err();
    assert!(why.contains("glass.yml: line 2: data of type `formula 2`") && why.contains("params"), "{why}");
    let why = recipe("none.csv").unwrap_err();
    assert!(why.contains("none.csv") && why.contains("relative to the folder"), "{why}");
}

/// Mitsuba's masking is G1 G1.
#[test]
fn every_table_for_mitsuba_says_separable() {
    for planned in preset("mitsuba").unwrap().plan().unwrap().tables {
        let params = format!("{:?}", planned.asked.request.params);
        assert!(params.contains("separable"), "{}: {params}", planned.name());
    }
}

/// Albedo of Mitsuba 3.9.1's white rough conductor at (mu, alpha), 65 536 jittered samples of its own sampler: standard errors to 2e-4.
const MITSUBA: &[(f64, f64, f64)] = &[
    (0.1, 0.3, 0.8424370),
    (0.3, 0.3, 0.8063321),
    (0.9, 0.3, 0.8671393),
    (0.1, 0.6, 0.7302419),
    (0.3, 0.6, 0.6649234),
    (0.9, 0.6, 0.5929816),
    (0.1, 1.0, 0.5579351),
    (0.3, 1.0, 0.4720466),
    (0.9, 1.0, 0.3230363),
];

/// The standard errors of [`MITSUBA`], over what it reflects at the least, and what reading from 64 x 64 texels adds.
const FURNACE: f64 = 1e-3;

/// What Mitsuba reflects, and what the table says that it loses.
#[test]
fn a_furnace_of_mitsuba_is_white_with_its_preset() {
    let furnace = |masking: &str| -> f64 {
        let plan = preset("mitsuba").unwrap().source.replace("\"separable\" }", &format!("\"{masking}\" }}"));
        let plan = brdfbake::recipe::parse(&plan, "mitsuba.toml").unwrap();
        let planned = plan.tables.iter().find(|t| t.name() == "ggx-e").unwrap();
        let cancel = Cancel::new();
        let on_miss = planned.asked.on_miss;
        let options = Options { tolerance: 1e-5, on_miss, cancel: &cancel, progress: &|_| {} };
        let table = bake(&planned.bound, options).unwrap();
        let one = |&(mu, alpha, reflected): &(f64, f64, f64)| {
            let mut e = [0.0];
            table.read(&table.grid.point(&[mu, alpha]).unwrap(), &mut e);
            (reflected / e[0] - 1.0).abs()
        };
        MITSUBA.iter().map(one).fold(0.0, f64::max)
    };
    assert!(furnace("separable") < FURNACE, "{}", furnace("separable"));
    assert!((0.26..0.27).contains(&furnace("correlated")), "{}", furnace("correlated"));
}

#[test]
fn default_tolerances_follow_the_finest_storage() {
    let tolerance = |id: &str, table: &str| {
        let plan = preset(id).unwrap().plan().unwrap();
        plan.tables.iter().find(|t| t.name() == table).unwrap().tolerance.to_bits()
    };
    assert_eq!(tolerance("default", "ggx-dfg"), f64::to_bits(0.000_244_140_625));
    assert_eq!(tolerance("default", "kelemen-beckmann"), f64::to_bits(0.5 / 65535.0));
    assert_eq!(tolerance("fresnel", "fresnel-both-sides"), f64::to_bits(2.980_232_238_769_531_25e-8));
    assert_eq!(tolerance("energy-compensation", "ggx-e"), f64::to_bits(1e-6));
}

/// White directional albedo of GGX with correlated masking at (mu, alpha): high-precision reference values, from two
/// quadratures that agree to 12 decimals.
const E: &[(f64, f64, f64)] = &[
    (0.05, 0.01, 0.976207590052),
    (0.05, 0.05, 0.889894054271),
    (0.05, 0.5, 0.912547797965),
    (0.1, 0.05, 0.911346937308),
    (0.1, 0.1, 0.883455001867),
    (0.1, 1.0, 0.760210472720),
    (0.25, 0.1, 0.921623156958),
    (0.25, 0.25, 0.840081899154),
    (0.5, 0.01, 0.999742122599),
    (0.5, 0.5, 0.698250696928),
    (0.75, 0.75, 0.501411121497),
    (1.0, 0.25, 0.915812430250),
    (1.0, 1.0, 0.306852819440),
];

#[test]
fn the_albedo_of_the_default_preset_is_read_as_well_as_its_comment_says() {
    let plan = preset("default").unwrap().plan().unwrap();
    let planned = plan.tables.iter().find(|t| t.name() == "ggx-albedo").unwrap();
    let cancel = Cancel::new();
    let options = Options {
        tolerance: planned.tolerance,
        on_miss: planned.asked.on_miss,
        cancel: &cancel,
        progress: &|_| {},
    };
    let table = bake(&planned.bound, options).unwrap();
    for &(mu, alpha, expected) in E {
        let mut got = [0.0];
        table.read(&table.grid.point(&[mu, alpha]).unwrap(), &mut got);
        let error = (got[0] - expected).abs();
        assert!(error < 1.9e-4, "E({mu}, {alpha}) = {} is off by {error:e}", got[0]);
    }
}

#[test]
fn the_preset_everything_has_every_kind_of_table() {
    let plan = preset("everything").unwrap().plan().unwrap();
    let kinds: Vec<&str> = plan.tables.iter().map(|t| t.bound.spec.kind.id).collect();
    for kind in brdfbake::tables::TABLES {
        assert!(kinds.contains(&kind.id), "{} is missing from presets/everything.toml", kind.id);
    }
}

#[test]
fn a_minimal_recipe_is_as_good_as_the_default_preset() {
    for p in ["default", "ggx"] {
        for table in preset(p).unwrap().plan().unwrap().tables {
            let spec = &table.bound.spec;
            let minimal = format!("name = 'x'\n[[table]]\nkind = '{}'\nname = 't'\n", spec.kind.id);
            let minimal = brdfbake::recipe::parse(&minimal, "x.toml").unwrap();
            assert_eq!(spec.grid, minimal.tables[0].bound.spec.grid, "{p}: {}", table.name());
        }
    }
}

#[test]
fn a_split_sum_of_kind_and_name_alone_reads_to_what_the_preset_says() {
    let plan =
        brdfbake::recipe::parse("name = 'x'\n[[table]]\nkind = 'dfg'\nname = 't'\n", "x.toml").unwrap();
    let planned = &plan.tables[0];
    let cancel = Cancel::default();
    let options =
        Options { tolerance: 1e-5, on_miss: planned.asked.on_miss, cancel: &cancel, progress: &|_| {} };
    let table = bake(&planned.bound, options).unwrap();
    let probe = Probe::new(&planned.bound, 1e-5, 1 << 14);
    let read = probe.measure(&table.values);
    assert!(read.whole.largest.value < 2.9e-3, "{read:?}");
    assert!(read.practical.unwrap().largest.value < 7.5e-4);
    let text = preset("default").unwrap().source;
    assert!(text.contains("off by at most 0.0029"), "the preset says what it reads to");
}

//! Two recipes that mean the same have the same hash; two that do not, have not. The canonical form is a recipe.

use brdfbake::plan::identity::Hasher;
use brdfbake::plan::{Input, Plan};
use brdfbake::recipe::{PRESETS, parse};

fn plan(source: &str) -> Plan {
    parse(source, "x.toml").unwrap_or_else(|e| panic!("{e}"))
}

const SHORT: &str = "name = 'x'\n[[table]]\nkind = 'dfg'\nname = 'a'\n";

/// The same with axes, in the shortest spelling.
const AXES: &str = "name = 'x'\n[[table]]\nkind = 'dfg'\nname = 'a'\n[[table.axis]]\nid = 'mu'\nlength = 64\nwarp = 'sqrt'\n\
                    [[table.axis]]\nid = 'roughness'\nlength = 64\n";

/// The same with everything spelled out, other key order, other spellings of numbers and warps.
const LONG: &str = r#"
table = [{ name = "a", axis = [
    { length = 0x40, id = "mu", warp = { power = 5e-1 }, domain = [0, 1], clamp = [-0.0, 1], offset = -0.0 },
    { id = "roughness", length = 64, warp = { one-minus-power = 1 }, texel = "endpoint", direction = "ascending" },
], waive = [], outputs = ["exr:half"], "on-miss" = "fail", reconstruction = "on", tolerance = 0.000244140625,
   params = { masking = "correlated", F90 = 1 }, model = "ggx_smith_correlated", layout = "scale-bias", kind = "dfg" }]
name = "x"
"#;

#[test]
fn spelling_does_not_matter() {
    let (short, long) = (plan(AXES), plan(LONG));
    assert_eq!(short.canonical().to_string(), long.canonical().to_string());
    assert_eq!(short.tables[0].identity, long.tables[0].identity);
    assert_eq!(short.hash, long.hash);
    assert_eq!(short.hash.len(), 64);
    let axis = &long.tables[0].bound.spec.grid.axes()[1];
    assert_eq!(axis.coordinate_formula(), "((roughness * 63) + 0.5) / 64");
    assert_eq!(axis, &short.tables[0].bound.spec.grid.axes()[1]);
}

#[test]
fn a_tolerance_of_the_recipe_is_that_of_its_tables() {
    let of_recipe = plan("name = 'x'\ntolerance = 1e-6\n[[table]]\nkind = 'dfg'\nname = 'a'\n");
    let of_table = plan("name = 'x'\n[[table]]\nkind = 'dfg'\nname = 'a'\ntolerance = 1e-6\n");
    assert_eq!(of_recipe.hash, of_table.hash);
    assert_ne!(of_recipe.hash, plan(SHORT).hash);
}

#[test]
fn every_difference_of_meaning_changes_the_hash() {
    let table = |more: &str| format!("name = 'x'\n[[table]]\nkind = 'albedo'\nname = 'a'\n{more}\n");
    let axis = |more: &str| {
        table(&format!(
            "[[table.axis]]\nid = 'mu'\nlength = 8\n{more}\n[[table.axis]]\nid = 'roughness'\nlength = 8"
        ))
    };
    let sources = [
        table(""),
        table("model = 'beckmann'"),
        table("params = { f0 = 0.5 }"),
        table("params = { masking = 'separable' }"),
        table("tolerance = 1e-5"),
        table("outputs = ['exr:float']\ntolerance = 0.000244140625"),
        table("outputs = ['exr:half', 'png:unorm16']\ntolerance = 0.000244140625"),
        table("on-miss = 'report'"),
        table("texels = 'minimax'"),
        table("texels = 'auto'"),
        table("size = 'auto'"),
        table("size = { error = 1e-2 }"),
        table("size = { domain = 'practical' }"),
        table("size = { warps = 'search' }"),
        table("size = { longest = 64 }"),
        table("outputs = ['ktx2:half']"),
        table("outputs = ['ktx2:half+rgba']"),
        table("outputs = ['text:half']\nbefore = 'x'"),
        table("outputs = ['text:half']\nafter = 'x'"),
        table("reconstruction = 'off'"),
        table("waive = [{ law = 'energy', reason = 'one' }]"),
        table("waive = [{ law = 'energy', reason = 'two' }]"),
        axis(""),
        axis("domain = [0.5, 1]"),
        axis("clamp = [0.5, 1]"),
        axis("warp = 'sqrt'"),
        axis("warp = 'square'"),
        axis("warp = 'sqrt-one-minus'"),
        axis("warp = { coupled = 'alpha' }"),
        axis("warp = { coupled = 'alpha', scale = 2 }"),
        axis("warp = { coupled = 'alpha', exponent = 2 }"),
        axis("texel = 'center'"),
        axis("direction = 'descending'"),
        axis("offset = 1"),
        axis("").replacen("length = 8", "length = 9", 1),
        axis("").replace("roughness", "alpha"),
    ];
    let mut hashes: Vec<String> = sources.iter().map(|s| plan(s).tables[0].identity.clone()).collect();
    hashes.push(plan(&table("").replace("name = 'a'", "name = 'b'")).tables[0].identity.clone());
    let all = hashes.len();
    hashes.sort();
    hashes.dedup();
    assert_eq!(hashes.len(), all);
}

#[test]
fn names_count_where_files_hold_them() {
    let table = |recipe: &str, name: &str, more: &str| {
        plan(&format!("name = '{recipe}'\n[[table]]\nkind = 'dfg'\nname = '{name}'\n{more}\n"))
    };
    let of = |plan: Plan| plan.tables[0].identity.clone();
    // metadata names the recipe and the table
    assert_ne!(of(table("x", "a", "")), of(table("y", "a", "")));
    assert_ne!(of(table("x", "a", "")), of(table("x", "b", "")));
    // numbers without a header name nothing
    let bare = "outputs = ['raw:float', 'text:half']";
    assert_eq!(of(table("x", "a", bare)), of(table("y", "b", bare)));
    let one = "outputs = ['raw:float', 'exr:half']";
    assert_ne!(of(table("x", "a", one)), of(table("y", "a", one)));
    // no file holds its own name, but the text round its numbers
    let file = |file: &str| of(table("x", "a", &format!("outputs = ['raw:float']\nfile = '{file}'")));
    assert_eq!(file("a.bin"), file("b.bin"));
    let round = |text: &str| of(table("x", "a", &format!("outputs = ['raw:float']\nbefore = '{text}'")));
    assert_ne!(round("1"), round("2"));
    assert_ne!(plan(SHORT).hash, plan(&SHORT.replace("'x'", "'y'")).hash);
    // nor the path of the recipe
    assert_eq!(parse(SHORT, "/somewhere/else.toml").unwrap().hash, plan(SHORT).hash);
}

#[test]
fn the_content_of_inputs_counts_and_their_place_does_not() {
    let hash = |inputs: &[Input]| Hasher::new("table").inputs(inputs).finish();
    let input = |role: &str, bytes: &[u8]| Input::new(role, bytes);
    let one = [input("roughness", b"abc"), input("normal", b"d")];
    assert_eq!(hash(&one), hash(&one.clone()));
    for other in [
        &[input("roughness", b"abd"), input("normal", b"d")][..],
        &[input("roughness", b"ab"), input("normal", b"cd")],
        &[input("normal", b"d"), input("roughness", b"abc")],
        &[input("metallic", b"abc"), input("normal", b"d")],
        &[input("roughness", b"abc")],
        &[],
    ] {
        assert_ne!(hash(&one), hash(other), "{other:?}");
    }
}

#[test]
fn the_canonical_form_is_a_recipe_that_means_the_same() {
    let waived = "name = 'w'\n[[table]]\nkind = 'albedo'\nname = 'a'\nmodel = 'cook-torrance-1982'\n\
                  waive = [{ law = 'range', reason = 'r' }, { law = 'energy', reason = ' e ' }]\n";
    for source in PRESETS.iter().map(|p| p.source).chain([SHORT, AXES, LONG, waived]) {
        let first = plan(source);
        let text = toml::to_string(&first.canonical()).unwrap();
        let second = plan(&text);
        assert_eq!(first.canonical().to_string(), second.canonical().to_string());
        assert_eq!(first.hash, second.hash);
    }
}

#[test]
fn waivers_and_outputs_have_no_order() {
    let source = |waive: &str, outputs: &str| {
        format!(
            "name = 'w'\n[[table]]\nkind = 'albedo'\nname = 'a'\nwaive = [{waive}]\noutputs = [{outputs}]\n"
        )
    };
    let (a, b) = ("{ law = 'range', reason = 'r' }", "{ law = 'energy', reason = 'e' }");
    let first = plan(&source(&format!("{a}, {b}"), "'exr:half', 'png:unorm16'"));
    let second = plan(&source(&format!("{b}, {a}"), "'png:unorm16', 'exr:half'"));
    assert_eq!(first.hash, second.hash);
    let laws: Vec<&str> = first.tables[0].asked.waivers.iter().map(|w| w.law.as_str()).collect();
    assert_eq!(laws, ["range", "energy"]);
}

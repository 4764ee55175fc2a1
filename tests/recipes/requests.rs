//! Plans made by a program, without a file.

use brdfbake::plan::{Output, Plan, TableRequest};
use brdfbake::recipe::parse;
use brdfbake::tables::spec::Request;

fn request(kind: &str) -> Request {
    Request { kind: kind.to_owned(), ..Request::default() }
}

#[test]
fn requests_and_files_make_the_same_plan() {
    let file = parse("name = 'x'\n[[table]]\nkind = 'dfg'\nname = 'a'\n", "x.toml").unwrap();
    let made = Plan::from_requests("x", vec![TableRequest::new("a", request("dfg"))]).unwrap();
    assert_eq!(made.hash, file.hash);
    assert_eq!(made.tables[0].canonical(), file.tables[0].canonical());
}

#[test]
fn requests_are_checked_like_files() {
    let mut bad = TableRequest::new("a/b", request("dgf"));
    bad.tolerance = Some(2.0);
    bad.outputs = Some(vec![Output::parse("exr:half").unwrap(), Output::parse("exr:half").unwrap()]);
    let error = Plan::from_requests("X", vec![bad]).unwrap_err();
    let paths: Vec<String> = error.faults.iter().map(|(p, _)| p.to_string()).collect();
    assert_eq!(
        paths,
        ["name", "table[0].name", "table[0].tolerance", "table[0].outputs[1]", "table[0].kind"]
    );
    let text = error.to_string();
    assert!(text.contains("table[0].kind: unknown table kind `dgf`; did you mean `dfg`?"), "{text}");
    let none = Plan::from_requests("x", Vec::new()).unwrap_err();
    assert!(none.to_string().contains("allowed: 1 to 256"), "{none}");
}

use maquette_graph::*;
fn main() {
    let c = Catalogue::new();
    let deep = format!("(version: 1, x: {}1{})", "(".repeat(200), ")".repeat(200));
    let d = format!("(version: 1, x: {}1{})", "[".repeat(200), "]".repeat(200));
    for t in ["", "  \n", "(", "(version: 1,\n nodes: {", "(version: 1,\n nodes: {\n \"a\": (kind: \"x\" inputs: {}),\n}\n)",
      "(version: 1, nodes: 5)", "(version: 1, nodes: { \"a\": 5 })", "(version: 1, nodes: { a: (kind: \"x\") })", "(version: 1, version: 2)",
      "(version: 1,\n nodes: {},\n) x", "[1]", "Graph(version: 1)", "(version: 1, nodes: { \"a\": Foo(kind: \"x\") })",
      "(version: 1, nodes: { \"a\": (kind: \"x\", inputs: { \"v\": 123456789012345678901234567890, \"w\": 1e999, \"x\": 5..6 }) })",
      "(version: 1, nodes: {\n \"a\": (kind: \"x\", inputs: { \"v\": 12 12 }) })", "(version: 1, nodes: {\n \"a\": (kind: \"x, inputs: { \"v\": 12 12 }) })",
      "(version: 1, /* unclosed", "(version: 1, notes: \"x\\q\")", "(1: 2)", "(\"version\": 1)", "{\"version\": 1}", "#![enable(implicit_some)]\n(version: 1)", "#![foo]\n(version: 1)",
      "(version: 1, r#a-b: 5, r: 6, r#true: 7, r#r: 8, b: 5, e\u{301}x: 9, ℘: 3, r#1: 2)", &deep, &d] {
        match file::from_text(&c, t) { Err(e) => println!("{:.60} => ERR {e}", t.replace('\n', "|")), Ok(l) => {
            println!("{:.60} => ok", t.replace('\n', "|"));
            for p in &l.problems { println!("     {p}"); }
            let s = file::to_text(&l.graph); println!("{s}");
            if let Err(e) = file::from_text(&c, &s) { println!("  RELOAD FAILS {e}"); }
        } }
        if let Err(e) = ron::from_str::<ron::Value>(t) { println!("    span {:?}", e.span); }
    }
}

//! Golden files: written, read back, run, and what they say where a node gives something else.
#![allow(
    clippy::unwrap_used,
    clippy::panic,
    clippy::disallowed_methods,
    reason = "a test that panics fails, and its files are its own"
)]

mod kinds;

use std::path::Path;

use kinds::{Rig, Samples, kind};
use maquette_graph::freeze::{Freeze, FreezeError, Frozen, Golden, ThawError, Tolerance};
use maquette_graph::{Catalogue, Choice, Colour, Literal, NodeKind, Stroke, StrokePoint, Strokes, Vector};
use proptest::prelude::*;

impl Freeze for Samples {
    fn freeze(&self) -> Frozen {
        Frozen::Numbers(self.0.clone())
    }

    fn thaw(frozen: &Frozen) -> Result<Self, ThawError> {
        frozen.numbers().map(|numbers| Self(numbers.to_vec()))
    }
}

fn rig() -> Rig {
    let mut rig = Rig::default();
    rig.catalogue.freezable::<Samples>();
    rig.add("samples", "rows");
    rig.add("measure", "sum");
    rig.link("rows.samples", "sum.samples");
    rig
}

fn golden(rig: &Rig, node: &str) -> Golden {
    Golden::of(&rig.catalogue, &rig.graph, rig.id(node), Path::new(""), Tolerance::default()).unwrap()
}

#[test]
fn a_node_is_frozen_with_what_arrives_at_its_inputs() {
    let mut rig = rig();
    // An equal node before it must not answer in its place.
    rig.add("measure", "same");
    rig.link("rows.samples", "same.samples");
    rig.link("same.total", "sum.offset");
    for node in ["same", "sum"] {
        let golden = golden(&rig, node);
        let text = golden.to_text();
        assert_eq!(Golden::from_text(&text).unwrap(), golden, "{text}");
        assert_eq!(golden.differences(&rig.catalogue).unwrap(), []);
    }
    let text = golden(&rig, "sum").to_text();
    assert!(text.contains("(\"samples\", Numbers([0.0, 1.0") && text.contains("(\"offset\", Number("), "{text}");
    assert!(text.contains("tolerance: (absolute: 1e-9, relative: 1e-9)"), "{text}");
}

#[test]
fn conversions_and_defaults_are_frozen_as_they_arrive() {
    let mut rig = Rig::default();
    rig.add("whole", "whole");
    rig.add("add", "add");
    rig.link("whole.integer", "add.a");
    let text = golden(&rig, "add").to_text();
    assert!(text.contains("(\"a\", Number(") && text.contains("(\"b\", Number(0.0))"), "{text}");
}

/// A stand-in that gives something else than the kind of that name.
fn changed(kind: &str, version: u32, total: f64) -> Catalogue {
    let mut node = NodeKind::declare(kind, version, "test", "Changed.");
    node.input::<Samples>("samples", "Anything.");
    node.optional::<f64>("offset", "Anything.");
    let out = node.output::<f64>("total", "Something else.");
    node.evaluate(move |ports| {
        ports.write(out, total);
        Ok(())
    });
    let mut catalogue = Catalogue::new();
    catalogue.freezable::<Samples>();
    catalogue.register(node).unwrap();
    catalogue
}

#[test]
fn what_differs_is_said_with_the_place_and_how_far() {
    let golden = golden(&rig(), "sum");
    let found = golden.differences(&changed("measure", 1, 3.5)).unwrap();
    assert_eq!(
        found.iter().map(ToString::to_string).collect::<Vec<_>>(),
        ["total: it was 3 and is 3.5, 5.000e-1 apart"]
    );
    assert_eq!(golden.differences(&changed("measure", 1, 3.0 + 2e-9)).unwrap(), [], "within 1e-9 of its size");
    assert_eq!(golden.differences(&changed("measure", 1, 3.0 + 4e-9)).unwrap().len(), 1);
    assert_eq!(golden.differences(&changed("measure", 1, f64::NAN)).unwrap().len(), 1);
    let updated = golden.updated(&changed("measure", 2, 3.5)).unwrap();
    assert_eq!(updated.differences(&changed("measure", 2, 3.5)).unwrap(), []);
    assert_eq!((updated.version, golden.version), (2, 1));
}

#[test]
fn what_can_not_be_run_says_why() {
    let golden = golden(&rig(), "sum");
    let fails = |catalogue: &Catalogue| golden.differences(catalogue).unwrap_err().to_string();
    assert!(fails(&Catalogue::new()).contains("no node kind is named \"measure\""));
    assert!(fails(&changed("measure", 2, 3.0)).contains("frozen at version 1 of \"measure\", which is at 2"));
    let mut narrow = NodeKind::declare("measure", 1, "test", "Lacks its input.");
    narrow.output::<f64>("total", "The sum.");
    let mut catalogue = Catalogue::new();
    catalogue.register(narrow).unwrap();
    assert!(fails(&catalogue).contains("\"measure\" has no input \"samples\""));
    assert!(matches!(Golden::from_text("(frozen: 1,"), Err(FreezeError::Syntax { line: 1, .. })));
    let later = golden.to_text().replacen("frozen: 1", "frozen: 2", 1);
    assert_eq!(Golden::from_text(&later), Err(FreezeError::TooNew(2)));
    let spoilt = Golden::from_text(&golden.to_text().replace("Numbers([", "Integers([").replace(".0", "")).unwrap();
    assert!(
        spoilt
            .differences(&rig().catalogue)
            .unwrap_err()
            .to_string()
            .contains("it holds whole numbers in place of numbers")
    );

    let mut unfit = Rig::default();
    unfit.add("samples", "rows");
    let refused = Golden::of(&unfit.catalogue, &unfit.graph, unfit.id("rows"), Path::new(""), Tolerance::default());
    assert!(refused.unwrap_err().to_string().contains("register it with `freezable`"));
    unfit.add("root", "root");
    unfit.set("root.number", -1.0);
    let failed = Golden::of(&unfit.catalogue, &unfit.graph, unfit.id("root"), Path::new(""), Tolerance::default());
    assert!(failed.unwrap_err().to_string().contains("the node has no result: input \"number\""));
}

#[test]
fn files_are_frozen_with_their_content() {
    let folder = tempfile::tempdir().unwrap();
    for (content, spelled) in
        [(&b"in \"quotes\"\n"[..], "Text(\"in \\\"quotes\\\"\\n\")"), (b"\xff\x00", "Bytes(\"/wA=\")")]
    {
        std::fs::write(folder.path().join("a.txt"), content).unwrap();
        let mut rig = Rig::default();
        rig.register(kind("length", |node| {
            let file = node.file("file", &["txt"], "Any file.");
            let out = node.output::<i64>("bytes", "Its length.");
            node.reads_file(file);
            node.evaluate(move |ports| {
                let length = i64::try_from(ports.file(file)?.len())?;
                ports.write(out, length);
                Ok(())
            });
        }));
        rig.add("length", "length");
        rig.put("length.file", Literal::File("a.txt".into()));
        let golden =
            Golden::of(&rig.catalogue, &rig.graph, rig.id("length"), folder.path(), Tolerance::default()).unwrap();
        assert!(golden.to_text().contains(spelled), "{}", golden.to_text());
        std::fs::remove_file(folder.path().join("a.txt")).unwrap();
        let read = Golden::from_text(&golden.to_text()).unwrap();
        assert_eq!(read.differences(&rig.catalogue).unwrap(), [], "without the file");
    }
}

#[test]
fn points_are_compared_by_distance_and_the_farthest_is_named() {
    #[derive(Clone)]
    struct Cloud(Vec<[f64; 3]>);
    impl maquette_graph::Wire for Cloud {
        const NAME: &'static str = "cloud";
        const DESCRIPTION: &'static str = "Points.";
        fn hash_content(&self, hasher: &mut maquette_graph::ContentHasher) {
            self.0.iter().for_each(|p| hasher.numbers(p));
        }
        fn byte_size(&self) -> usize {
            24 * self.0.len()
        }
        fn summary(&self) -> String {
            String::new()
        }
    }
    impl Freeze for Cloud {
        fn freeze(&self) -> Frozen {
            Frozen::List(vec![Frozen::record([("points", Frozen::Points(self.0.clone()))])])
        }
        fn thaw(frozen: &Frozen) -> Result<Self, ThawError> {
            Ok(Self(frozen.list()?[0].field("points")?.points()?.to_vec()))
        }
    }
    let catalogue = |points: Vec<[f64; 3]>| {
        let mut catalogue = Catalogue::new();
        catalogue.freezable::<Cloud>();
        let cloud = kind("cloud", |node| {
            let out = node.output::<Cloud>("cloud", "Points.");
            node.evaluate(move |ports| {
                ports.write(out, Cloud(points.clone()));
                Ok(())
            });
        });
        catalogue.register(cloud).unwrap();
        catalogue
    };
    let before = catalogue(vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 0.0, 100.0]]);
    let mut graph = maquette_graph::Graph::new();
    let node = graph.add(&before, "cloud", "cloud").unwrap();
    let golden = Golden::of(&before, &graph, node, Path::new(""), Tolerance::default()).unwrap();
    // A hundred metres out, 5e-8 m is rounding; near the origin it is not.
    let after = catalogue(vec![[0.0, 3e-8, 4e-8], [1.0, 2e-9, 0.0], [0.0, 0.0, 100.000_000_05]]);
    let found = golden.differences(&after).unwrap();
    assert_eq!(found.len(), 1);
    let said = found[0].to_string();
    assert!(said.starts_with("cloud[0].points[0]: ") && said.contains("5.000e-8 m apart; 1 others differ"), "{said}");
    let fewer = golden.differences(&catalogue(vec![[0.0; 3]])).unwrap();
    assert_eq!(fewer[0].to_string(), "cloud[0].points: there were 3 and are 1");
}

fn back<T: Freeze>(value: &T) -> T {
    T::thaw(&value.freeze()).unwrap()
}

proptest! {
    /// What a golden file holds comes back to the last bit, whatever the text.
    #[test]
    fn frozen_data_reads_back(
        numbers in prop::collection::vec(prop::num::f64::ANY.prop_filter("equal to itself", |n| !n.is_nan()), 0..40),
        text in any::<String>(),
        integers in prop::collection::vec(any::<i64>(), 0..40),
    ) {
        let mut rig = Rig::default();
        rig.catalogue.freezable::<Samples>();
        let (samples, spoken) = (numbers.clone(), text.clone());
        rig.register(kind("speaks", |node| {
            let (a, b) = (node.output::<Samples>("samples", "Numbers."), node.output::<String>("text", "A text."));
            let c = node.output::<i64>("integer", "A whole number.");
            let last = integers.last().copied().unwrap_or(0);
            node.evaluate(move |ports| {
                ports.write(a, Samples(samples.clone()));
                ports.write(b, spoken.clone());
                ports.write(c, last);
                Ok(())
            });
        }));
        rig.add("speaks", "speaks");
        let golden = golden(&rig, "speaks");
        let read = Golden::from_text(&golden.to_text()).unwrap();
        prop_assert_eq!(&read, &golden);
        prop_assert_eq!(read.differences(&rig.catalogue).unwrap(), []);
    }

    #[test]
    fn literals_come_back(x in -1e6..1e6, y in -1e6..1e6, pressure in prop::option::of(0.0..1.0), closed: bool) {
        let stroke = Stroke { name: "hem".into(), closed, points: vec![StrokePoint { x, y, pressure }; 3] };
        let strokes = Strokes(vec![stroke.clone(), Stroke { name: String::new(), ..stroke }]);
        prop_assert_eq!(back(&strokes), strokes);
        prop_assert_eq!(back(&Vector([x, y, x])), Vector([x, y, x]));
        prop_assert_eq!(back(&Colour([x, y, x, y])), Colour([x, y, x, y]));
        prop_assert_eq!(back(&Choice("a".into())), Choice("a".into()));
        prop_assert_eq!((back(&x), back(&closed), back(&7_i64)), (x, closed, 7));
    }
}

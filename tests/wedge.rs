//! `maquette wedge`: many variants in one process.
#![allow(
    clippy::unwrap_used,
    clippy::panic,
    clippy::disallowed_methods,
    reason = "a test that panics fails, and its files are its own"
)]

mod command;

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use command::{SKETCH, file, maquette, said, str};
use serde_json::Value as Json;
use tempfile::TempDir;

fn vest() -> String {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("graphs/vest.ron").to_str().unwrap().to_owned()
}

/// A folder with the vest in it.
fn place() -> (TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let graph = file(&folder, "vest.ron", std::fs::read(vest()).unwrap());
    (folder, graph)
}

/// Runs the command in a folder.
fn wedge(folder: &TempDir, arguments: &[&str]) -> (i32, String, String) {
    let mut command = Command::new(env!("CARGO_BIN_EXE_maquette"));
    said(&command.arg("wedge").args(arguments).current_dir(folder.path()).output().unwrap())
}

/// The same, with what it says as data.
fn data(folder: &TempDir, arguments: &[&str]) -> (i32, Json, String) {
    let (code, out, err) = wedge(folder, &[arguments, &["--json"]].concat());
    (code, serde_json::from_str(&out).unwrap_or_else(|error| panic!("{error}: {out}{err}")), err)
}

/// A field of all variants.
fn column(json: &Json, field: &str) -> Vec<String> {
    let variants = json["variants"].as_array().unwrap().iter();
    variants.map(|variant| variant[field].as_str().map_or_else(|| variant[field].to_string(), str::to_owned)).collect()
}

fn names(folder: &Path) -> Vec<String> {
    let mut names: Vec<String> =
        std::fs::read_dir(folder).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

const EARLY: &str = "body.k_s=0.5,1,2";
const LATE: &str = "surface.rows=1,2";

#[test]
fn all_combinations_are_written_as_run_writes_each() {
    let (folder, graph) = place();
    let pattern = "out/{body.k_s}/{surface.rows}.glb";
    let (code, out, err) = wedge(&folder, &["vest.ron", "--vary", EARLY, "--vary", LATE, "-o", pattern]);
    assert_eq!((code, err.as_str()), (0, ""), "{out}");
    for k_s in ["0.5", "1", "2"] {
        for rows in ["1", "2"] {
            let alone = folder.path().join("alone.glb");
            let set = [format!("body.k_s={k_s}"), format!("surface.rows={rows}")];
            let arguments = ["run", str(&graph), "--set", &set[0], "--set", &set[1], "-o", str(&alone)];
            assert_eq!(maquette(&arguments).0, 0);
            let written = folder.path().join(format!("out/{k_s}/{rows}.glb"));
            assert_eq!(std::fs::read(written).unwrap(), std::fs::read(alone).unwrap(), "{k_s} {rows}");
        }
    }
}

#[test]
fn only_what_differs_runs_and_the_table_keeps_the_order_asked_for() {
    let (folder, _) = place();
    // Behind `body` are body, shaped, surface and vest; behind `surface` the last two.
    for (first, second, ran) in
        [(EARLY, LATE, ["22", "2", "4", "2", "4", "2"]), (LATE, EARLY, ["22", "4", "4", "2", "2", "2"])]
    {
        for threads in ["1", "8"] {
            let (code, json, _) = data(&folder, &["vest.ron", "--vary", first, "--vary", second, "--threads", threads]);
            assert_eq!((code, column(&json, "ran")), (0, ran.map(str::to_owned).into()), "{first} {second}");
            let values: Vec<Json> = json["variants"].as_array().unwrap().iter().map(|v| v["values"].clone()).collect();
            let (address, _) = second.split_once('=').unwrap();
            assert_ne!(values[0][address], values[1][address], "the last address varies fastest");
        }
    }
}

#[test]
fn the_table_is_text_csv_and_json() {
    let (folder, _) = place();
    let tables = ["--table", "t/a.csv", "--table", "t/a.json", "--table", "t/a.txt"];
    let arguments = ["vest.ron", "--vary", EARLY, "--vary", LATE];
    let (code, out, _) = wedge(&folder, &[&arguments[..], &tables[..]].concat());
    assert_eq!(code, 0);
    let head = out.lines().next().unwrap();
    for column in ["body.k_s", "surface.rows", "state", "ms", "ran", "hits", "vest vertices", "vest faces"] {
        assert!(head.contains(column), "{column}: {head}");
    }
    assert!(out.contains("\nthe same in all: sketch lines curves 8"), "{out}");
    assert!(out.contains("6 variants: 6 done; 36 nodes run"), "{out}");
    let csv = std::fs::read_to_string(folder.path().join("t/a.csv")).unwrap();
    assert!(csv.starts_with("index,body.k_s,surface.rows,state,seconds,ran,hits,vest vertices,vest faces,"), "{csv}");
    assert!(csv.contains("body.largest-gap [m]") && csv.lines().count() == 7, "{csv}");
    let json: Json = serde_json::from_slice(&std::fs::read(folder.path().join("t/a.json")).unwrap()).unwrap();
    assert_eq!(json["variants"][3]["results"][0]["faces"], 7520);
    assert_eq!(json["variants"][3]["figures"][0]["unit"], "m");
    let text = std::fs::read_to_string(folder.path().join("t/a.txt")).unwrap();
    assert!(text.starts_with(head) && out.starts_with(text.split_once("\nthe").unwrap().0), "{text}");
}

#[test]
fn one_failure_does_not_stop_the_rest() {
    let (folder, _) = place();
    // Rails that must end exactly on the hem don't.
    let arguments = ["vest.ron", "--vary", "body.snap=0,0.02", "--vary", LATE, "-o", "out/{index}.ply"];
    let (code, json, err) = data(&folder, &arguments);
    assert_eq!((code, column(&json, "state")), (1, ["failed", "failed", "done", "done"].map(str::to_owned).into()));
    assert_eq!(names(&folder.path().join("out")), ["3.ply", "4.ply", "wedge.jsonl"]);
    assert!(err.contains("node \"body\"") && err.contains("(variant 1: body.snap=0 surface.rows=1)"), "{err}");
    // What failed is tried again, what is done is kept.
    let (code, json, _) = data(&folder, &arguments);
    assert_eq!((code, column(&json, "state")), (1, ["failed", "failed", "kept", "kept"].map(str::to_owned).into()));
    // What succeeded of them is written on request.
    let (code, json, _) =
        data(&folder, &[&arguments[..5], &["-o", "curves/{index}{body.snap}.json", "--keep-going"]].concat());
    assert_eq!(code, 1, "{json}");
}

#[test]
fn limits_are_held_against_each_variant() {
    let (folder, _) = place();
    // A hem that lies lower than the rails end.
    let arguments = ["vest.ron", "--vary", "hem.offset=0.921,0.93", "--fail-if", "body.largest-gap > 0.001"];
    let (code, json, err) = data(&folder, &[&arguments[..], &["-o", "b/{index}.glb"]].concat());
    assert_eq!((code, column(&json, "state")), (1, vec!["exceeded".to_owned(), "done".to_owned()]));
    assert!(err.contains("it fails 'body.largest-gap") && err.contains("(variant 1: hem.offset=0.921)"), "{err}");
    assert_eq!(names(&folder.path().join("b")), ["2.glb", "wedge.jsonl"]);
    // Also what was measured for an earlier variant, and did not run again.
    let (code, json, _) = data(&folder, &["vest.ron", "--vary", LATE, "--fail-if", "largest-gap > 1e-9"]);
    assert_eq!((code, column(&json, "state")), (1, vec!["exceeded".to_owned(); 2]));
    let (code, _, err) = wedge(&folder, &["vest.ron", "--vary", EARLY, "--fail-if", "body.largest-gop > 1"]);
    assert!(code == 2 && err.contains("did you mean \"body.largest-gap\"?"), "{err}");
}

#[test]
fn a_second_call_does_only_what_is_missing_or_changed() {
    let (folder, graph) = place();
    let arguments = ["vest.ron", "--vary", EARLY, "--vary", LATE, "-o", "out/{body.k_s}-{surface.rows}.obj"];
    let states = |arguments: &[&str]| column(&data(&folder, arguments).1, "state");
    let all = |state: &str| vec![state.to_owned(); 6];
    assert_eq!(states(&arguments), all("done"));
    assert_eq!(states(&arguments), all("kept"));
    // A file is gone, one is another, and of one only the material is gone.
    let out = folder.path().join("out");
    std::fs::remove_file(out.join("0.5-1.obj")).unwrap();
    let mut changed = std::fs::read(out.join("1-1.obj")).unwrap();
    changed[3] ^= 1;
    std::fs::write(out.join("1-1.obj"), changed).unwrap();
    std::fs::remove_file(out.join("2-2.mtl")).unwrap();
    assert_eq!(states(&arguments), ["done", "kept", "done", "kept", "kept", "done"]);
    assert_eq!(states(&arguments), all("kept"));
    // More values: only those are made.
    let more = ["vest.ron", "--vary", "body.k_s=0.5,0.7,1,2", "--vary", LATE, "-o", arguments[6]];
    assert_eq!(states(&more), ["kept", "kept", "done", "done", "kept", "kept", "kept", "kept"]);
    // What is only moved on the canvas is the same graph; another value is not.
    let text = std::fs::read_to_string(&graph).unwrap();
    std::fs::write(&graph, text.replace("\n    },\n)\n", "\n    },\n    layout: { \"hem\": (7.0, 7.0) },\n)\n"))
        .unwrap();
    assert_eq!(states(&arguments), all("kept"));
    std::fs::write(&graph, text.replacen("value: 0.17", "value: 0.18", 1)).unwrap();
    assert_eq!(states(&arguments), all("done"));
    std::fs::write(&graph, &text).unwrap();
    assert_eq!(states(&arguments), all("done"), "the files are those of the other graph");
    assert_eq!(states(&[&arguments[..], &["--fresh"]].concat()), all("done"));
    assert_eq!(states(&[&arguments[..], &["--no-record"]].concat()), all("done"));
}

#[test]
fn files_that_the_graph_reads_count_as_part_of_it() {
    let folder = tempfile::tempdir().unwrap();
    let curves = |x: f64| format!("{{\"contours\": [{{\"points\": [[0,0,0],[{x},0,0],[{x},1,0]]}}]}}");
    file(&folder, "a.json", curves(1.0));
    file(&folder, "b.json", curves(2.0));
    let graph = "(version: 1, nodes: {
        \"in\": (kind: \"import-curves\", inputs: { \"file\": File(\"a.json\") }),
        \"out\": (kind: \"curves-out\", inputs: { \"curves\": Link(\"in.curves\") }),
    })";
    file(&folder, "g.ron", graph);
    let arguments = ["g.ron", "--vary", "in.file=a.json,b.json", "-o", "out/{in.file}.json"];
    let (code, json, err) = data(&folder, &arguments);
    assert_eq!((code, column(&json, "state")), (0, vec!["done".to_owned(); 2]), "{err}");
    assert_eq!(names(&folder.path().join("out")), ["a.json", "b.json", "wedge.jsonl"]);
    file(&folder, "b.json", curves(3.0));
    let (_, json, _) = data(&folder, &arguments);
    assert_eq!(column(&json, "state"), ["kept", "done"]);
}

/// Lines of a record that are whole, but for the head.
fn recorded(record: &Path) -> usize {
    let text = std::fs::read_to_string(record).unwrap_or_default();
    text.split_inclusive('\n').filter(|line| line.ends_with('\n')).count().saturating_sub(1)
}

const LONG: [&str; 6] = ["vest.ron", "--vary", "body.k_s=0.1..10:40:log", "--vary", "surface.rows=1..4", "--threads=1"];

/// Starts a long wedge and calls back as soon as a few variants are finished.
fn interrupted(folder: &TempDir, interrupt: impl FnOnce(&mut std::process::Child)) -> (i32, String) {
    let mut command = Command::new(env!("CARGO_BIN_EXE_maquette"));
    command.arg("wedge").args(LONG).args(["-o", "out/{index}.glb"]).current_dir(folder.path());
    let mut child = command.stdout(Stdio::null()).stderr(Stdio::piped()).spawn().unwrap();
    let record = folder.path().join("out/wedge.jsonl");
    while recorded(&record) < 5 {
        assert!(child.try_wait().unwrap().is_none(), "it ended by itself");
    }
    interrupt(&mut child);
    let output = child.wait_with_output().unwrap();
    (output.status.code().unwrap_or(-1), String::from_utf8(output.stderr).unwrap())
}

fn continues(folder: &TempDir) {
    let before = recorded(&folder.path().join("out/wedge.jsonl"));
    assert!((5..160).contains(&before), "{before}");
    let (code, json, _) = data(folder, &[&LONG[..], &["-o", "out/{index}.glb"]].concat());
    let kept = column(&json, "state").iter().filter(|state| *state == "kept").count();
    assert_eq!((code, kept, &json["done"]), (0, before, &Json::from(160 - before)));
    // Nothing is different from a wedge that was not interrupted.
    data(folder, &[&LONG[..], &["-o", "whole/{index}.glb"]].concat());
    for variant in 1..=160 {
        let read = |place: &str| std::fs::read(folder.path().join(format!("{place}/{variant:03}.glb"))).unwrap();
        assert!(read("out") == read("whole"), "{variant}");
    }
}

#[test]
fn a_wedge_that_was_killed_is_continued() {
    let (folder, _) = place();
    interrupted(&folder, |child| child.kill().unwrap());
    continues(&folder);
}

#[cfg(unix)]
#[test]
fn a_wedge_that_was_stopped_says_so_and_is_continued() {
    let (folder, _) = place();
    let (code, err) = interrupted(&folder, |child| {
        assert!(Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap().success());
    });
    assert_eq!(code, 1);
    assert!(err.starts_with("stopped: ") && err.contains("of 160 variants are finished; the same command"), "{err}");
    continues(&folder);
}

#[test]
fn addresses_vary_together_or_are_sampled() {
    let (folder, _) = place();
    let listed = |arguments: &[&str]| {
        let (code, json, err) = data(&folder, &[&["vest.ron", "--dry-run"], arguments].concat());
        assert_eq!(code, 0, "{err}");
        column(&json, "values")
    };
    let zipped = listed(&["--vary", "body.k_s=1..3:3", "--vary", "body.nodes=10..12", "--zip"]);
    assert_eq!(zipped[1], r#"{"body.k_s":"2","body.nodes":"11"}"#);
    assert_eq!(zipped.len(), 3);
    let ranges = ["--vary", "body.k_s=0.1..10:log", "--vary", "hem.offset=0.9..1", "--seed", "4"];
    let few = listed(&[&ranges[..], &["--samples", "8"]].concat());
    let more = listed(&[&ranges[..], &["--samples", "20"]].concat());
    assert_eq!((few.len(), more.len(), &more[..8]), (8, 20, &few[..]));
    assert!(names(folder.path()) == ["vest.ron"], "a list makes no files");
    let (code, out, _) = wedge(&folder, &["vest.ron", "--dry-run", "--vary", EARLY, "-o", "out/{index}.obj"]);
    assert_eq!(code, 0);
    let expected = "#  body.k_s  files\n1       0.5  out/1.obj out/1.mtl\n2         1  out/2.obj out/2.mtl\n\
                    3         2  out/3.obj out/3.mtl\n";
    assert_eq!(out.split_once("vest.ron:").map_or(out.as_str(), |(table, _)| table), expected);
}

fn sheet(folder: &TempDir, name: &str) -> image::RgbImage {
    image::load_from_memory(&std::fs::read(folder.path().join(name)).unwrap()).unwrap().to_rgb8()
}

#[test]
fn the_sheet_shows_each_variant_from_one_camera() {
    let (folder, _) = place();
    let arguments =
        ["vest.ron", "--vary", "body.snap=0,0.2", "--vary", "neckline.offset=1.35,1.43", "--tile", "120x90"];
    let (code, _, err) = wedge(&folder, &[&arguments[..], &["--sheet", "a/s.png", "--threads", "1"]].concat());
    assert_eq!(code, 1, "{err}");
    let picture = sheet(&folder, "a/s.png");
    // Two columns; the first row failed and says so on its paper.
    assert_eq!(picture.width(), 2 * 120 + 16 + 2 * 24);
    let blue = |left: u32, top: u32| {
        let pixels = (0..90).flat_map(|y| (0..120).map(move |x| (x, y)));
        let blue = pixels.filter(|(x, y)| {
            let [r, _, b] = picture.get_pixel(left + x, top + y).0;
            i32::from(b) - i32::from(r) > 30
        });
        blue.map(|(_, y)| y).collect::<Vec<u32>>()
    };
    let top = 24 + 20 + 4 + 16 + 16;
    let line = (picture.height() - top - 24 - 2 * 90 - 16) / 2;
    let second = top + 90 + line + 16;
    assert_eq!((blue(24, top).len(), blue(24 + 136, top).len()), (0, 0));
    let (short, tall) = (blue(24, second), blue(24 + 136, second));
    assert!(short.len() > 200 && tall.len() > short.len(), "{} {}", short.len(), tall.len());
    // Both stand on the same floor: one camera sees them, so the lower neckline is lower in the picture.
    assert_eq!(short.iter().max(), tall.iter().max());
    assert!(short.iter().min() > tall.iter().min());
    // Any number of threads, and a wedge that is continued, draw the same.
    wedge(&folder, &[&arguments[..], &["--sheet", "b.png", "--threads", "8", "-o", "o/{index}.glb"]].concat());
    wedge(&folder, &[&arguments[..], &["--sheet", "c.png", "-o", "o/{index}.glb"]].concat());
    let read = |name: &str| std::fs::read(folder.path().join(name)).unwrap();
    assert!(read("a/s.png") == read("b.png") && read("b.png") == read("c.png"));
}

#[test]
fn curves_are_drawn_where_there_is_no_mesh() {
    let folder = tempfile::tempdir().unwrap();
    file(&folder, "g.ron", SKETCH);
    let (code, _, err) = wedge(&folder, &["g.ron", "--vary", "even.count=4..7", "--sheet", "s.png"]);
    assert_eq!((code, err.as_str()), (0, ""));
    assert!(sheet(&folder, "s.png").width() > 280);
}

#[test]
fn what_is_wrong_is_said_before_anything_runs() {
    let (folder, _) = place();
    for (arguments, expected) in [
        (
            &["--vary", "bodi.k_s=1,2"][..],
            "vest.ron: error: --vary bodi.k_s=1,2: no node is named \"bodi\"; did you mean",
        ),
        (&["--vary", "body.k_s=1..2"], "say how many values"),
        (&["--vary", "body.k_s=1,2", "--vary", "body.k_s=3"], "is given twice"),
        (&["--vary", "body.k_s=1,2", "--set", "body.k_s=3"], "both set and varied"),
        (&["--vary", "body.k_s=1,2", "-o", "a.glb"], "put {index} or more addresses into the name"),
        (&["--vary", "body.k_s=1,2", "-o", "{k_s}.glb"], "{k_s} is not varied; there is {body.k_s}, {index}"),
        (&["--vary", "body.k_s=1,2", "-o", "{index}.svg"], "end it in the format to write"),
        (&["--vary", "body.k_s=1,2", "--table", "a.xls"], "end it in .csv, .json or .txt"),
        (&["--vary", "body.k_s=1,2", "--table", "vest.ron"], "end it in"),
        (&["--vary", "body.k_s=1,2", "--sheet", "a.jpg"], "pictures are written as .png"),
        (&["--vary", "body.k_s=1,2", "--table", "a.csv", "--table", "a.csv"], "this is --table already"),
        (&["--vary", "body.k_s=1,2", "--record", "vest.ron", "-o", "{index}.glb"], "this is the graph already"),
        (&["--vary", "body.k_s=1..2:400", "--vary", "body.k_b=1..2:400"], "400 x 400 combinations are too many"),
        (&["--vary", "body.k_s=1,2", "--fail-if", "gap"], "there is no >, >=, < or <="),
        (&["--vary", "body.k_s=1,2", "--zip=body.k_s"], "two addresses that vary together"),
    ] {
        let (code, out, err) = wedge(&folder, &[&["vest.ron"], arguments].concat());
        assert_eq!((code, out.as_str()), (2, ""), "{arguments:?}: {err}");
        assert!(err.contains(expected), "{arguments:?}: {err}");
        assert_eq!(names(folder.path()), ["vest.ron"], "{arguments:?}");
    }
    let (code, _, err) = wedge(&folder, &["vest.ron", "--output", "vest", "--vary", "drawn curves.a=1"]);
    assert!(code == 2 && err.contains("from a link"), "{err}");
}

#[test]
fn values_that_change_no_result_are_pointed_out() {
    let folder = tempfile::tempdir().unwrap();
    let unused = SKETCH.replace("    nodes: {\n", "    nodes: {\n        \"spare\": (kind: \"resample\"),\n");
    file(&folder, "g.ron", unused);
    let (code, _, err) = wedge(&folder, &["g.ron", "--vary", "spare.count=4..7"]);
    assert!(code == 0 && err.contains("--vary spare.count: no result that is asked for depends on it"), "{err}");
}

#[test]
fn a_file_that_cannot_be_written_has_its_own_exit_code() {
    let (folder, _) = place();
    file(&folder, "out", "a file where a folder should be");
    let (code, json, err) = data(&folder, &["vest.ron", "--vary", EARLY, "-o", "out/{index}.glb", "--no-record"]);
    assert_eq!((code, column(&json, "state")), (3, vec!["not-written".to_owned(); 3]), "{err}");
    assert!(err.contains("out: the folder can't be made"), "{err}");
}

#[test]
fn a_job_template_holds_the_same_wedge() {
    let (folder, _) = place();
    let arguments = [
        "vest.ron",
        "--vary",
        "body.k_s=0.5,1",
        "--vary",
        "body.nodes=60,70",
        "--vary",
        "chest.plane=*",
        "--zip=body.k_s,body.nodes",
        "--set",
        "surface.rows=2",
        "--output",
        "vest",
        "-o",
        "out/{chest.plane}/{body.k_s}.glb",
        "-o",
        "out/{chest.plane}-{body.nodes}.ply",
        "--openjd",
        "job.json",
    ];
    let (code, out, err) = wedge(&folder, &arguments);
    assert_eq!((code, err.as_str()), (0, ""), "{out}");
    assert_eq!(names(folder.path()), ["job.json", "vest.ron"], "nothing is evaluated");
    let job: Json = serde_json::from_slice(&std::fs::read(folder.path().join("job.json")).unwrap()).unwrap();
    assert_eq!(job["specificationVersion"], "jobtemplate-2023-09");
    let parameter = |name: &str| {
        job["parameterDefinitions"].as_array().unwrap().iter().find(|p| p["name"] == name).unwrap().clone()
    };
    assert_eq!((&parameter("Graph")["type"], &parameter("Graph")["default"]), (&"PATH".into(), &"vest.ron".into()));
    assert_eq!(
        (&parameter("OutputFolder")["dataFlow"], &parameter("OutputFolder")["default"]),
        (&"OUT".into(), &"out".into())
    );
    assert_eq!(parameter("Maquette")["default"], "maquette");
    let step = &job["steps"][0];
    assert_eq!(step["parameterSpace"]["combination"], "(body_k_s, body_nodes) * chest_plane");
    let definitions = step["parameterSpace"]["taskParameterDefinitions"].to_string();
    let expected = concat!(
        r#"[{"name":"body_k_s","range":["0.5","1"],"type":"STRING"},{"name":"body_nodes","range":[60,70],"type":"INT"},"#,
        r#"{"name":"chest_plane","range":["front","side","top"],"type":"STRING"}]"#
    );
    assert_eq!(definitions, expected);
    let action = &step["script"]["actions"]["onRun"];
    assert_eq!(action["command"], "{{Param.Maquette}}");
    let args: Vec<&str> = action["args"].as_array().unwrap().iter().map(|a| a.as_str().unwrap()).collect();
    assert_eq!(
        args,
        [
            "run",
            "{{Param.Graph}}",
            "--set",
            "surface.rows=2",
            "--set",
            "body.k_s={{Task.Param.body_k_s}}",
            "--set",
            "body.nodes={{Task.Param.body_nodes}}",
            "--set",
            "chest.plane={{Task.Param.chest_plane}}",
            "--output",
            "vest",
            "--create-folders",
            "-o",
            "{{Param.OutputFolder}}/{{Task.Param.chest_plane}}/{{Task.Param.body_k_s}}.glb",
            "-o",
            "{{Param.OutputFolder}}/{{Task.Param.chest_plane}}-{{Task.Param.body_nodes}}.ply",
        ]
    );
}

#[test]
fn a_job_template_writes_out_what_it_cannot_count_and_names_files_safely() {
    let (folder, _) = place();
    let job = |arguments: &[&str]| {
        let (code, _, err) = wedge(&folder, &[&["vest.ron", "--openjd", "job.yaml"], arguments].concat());
        let read = || serde_json::from_slice(&std::fs::read(folder.path().join("job.yaml")).unwrap()).unwrap();
        if code == 0 { Ok::<Json, String>(read()) } else { Err(err) }
    };
    let sampled =
        job(&["--vary", "body.k_s=0.1..1", "--vary", "surface.rows=1..3", "--samples", "5", "-o", "{index}.glb"]);
    let space = sampled.unwrap()["steps"][0]["parameterSpace"].clone();
    assert_eq!(space["combination"], "(body_k_s, surface_rows, index)");
    let lengths =
        space["taskParameterDefinitions"].as_array().unwrap().iter().map(|p| p["range"].as_array().unwrap().len());
    assert_eq!(lengths.collect::<Vec<_>>(), [5, 5, 5]);
    let vectors =
        job(&["--vary", "tilted neckline.rotate=(0,0,0),(16,0,0)", "-o", "{tilted neckline.rotate}.glb"]).unwrap();
    let step = &vectors["steps"][0];
    assert_eq!(step["parameterSpace"]["taskParameterDefinitions"][0]["range"], serde_json::json!(["0,0,0", "16,0,0"]));
    assert_eq!(step["parameterSpace"]["taskParameterDefinitions"][1]["range"], serde_json::json!(["0_0_0", "16_0_0"]));
    assert_eq!(step["parameterSpace"]["combination"], "(tilted_neckline_rotate, tilted_neckline_rotate_name)");
    assert!(step.to_string().contains("{{Param.OutputFolder}}/{{Task.Param.tilted_neckline_rotate_name}}.glb"));
    for (arguments, expected) in [
        (&["--vary", "body.k_s=1,2"][..], "give -o as well"),
        (&["--vary", "body.k_s=1,2", "-o", "{{a}}{index}.glb"], "curly brackets"),
        (&["--vary", "body.k_s=1..2:1100", "-o", "{body.k_s}.glb"], "takes 1100 values, and a template holds 1024"),
    ] {
        let error = job(arguments).unwrap_err();
        assert!(error.contains(expected), "{error}");
    }
}

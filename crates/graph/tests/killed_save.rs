//! A save that is killed at any moment leaves the old file or the new one, whole.

#![cfg(unix)]
#![allow(
    clippy::unwrap_used,
    clippy::panic,
    clippy::disallowed_methods,
    reason = "a test that panics fails, and its files are its own"
)]

mod kinds;

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::Duration;

use kinds::Rig;
use maquette_graph::file;

/// Says to the process that saves where to save.
const TARGET: &str = "MAQUETTE_TEST_SAVES_TO";

/// How often it is killed.
const KILLS: u64 = 60;

/// Two graphs whose texts are some hundred kilobytes long, of different length.
fn graphs() -> [Rig; 2] {
    [2_000, 3_000].map(|length| {
        let mut rig = Rig::default();
        rig.chain(length);
        rig
    })
}

/// Not a test of its own: the process that [`a_killed_save_leaves_a_whole_file`] starts and kills.
#[test]
fn saves_until_it_is_killed() {
    let Some(target) = std::env::var_os(TARGET).map(PathBuf::from) else { return };
    let graphs = graphs();
    loop {
        for rig in &graphs {
            file::save(&rig.graph, &target).unwrap();
        }
    }
}

fn unfinished(folder: &Path) -> usize {
    let names = std::fs::read_dir(folder).unwrap().map(|e| e.unwrap().file_name().to_string_lossy().into_owned());
    names.filter(|name| name.starts_with(".maquette-")).count()
}

#[test]
fn a_killed_save_leaves_a_whole_file() {
    let folder = tempfile::tempdir().unwrap();
    let target = folder.path().join("graph.ron");
    let graphs = graphs();
    let texts = graphs.each_ref().map(|rig| file::to_text(&rig.graph));
    file::save(&graphs[0].graph, &target).unwrap();
    let mut saver = Command::new(std::env::current_exe().unwrap());
    saver.args(["--exact", "saves_until_it_is_killed"]).env(TARGET, &target);
    saver.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
    let (mut seen, mut caught_at_work) = ([0, 0], 0);
    for kill in 0..KILLS {
        let mut process = saver.spawn().unwrap();
        // In turn after a save of the first graph and of the second, however slow the machine is.
        let wanted = texts[kill as usize % 2].len() as u64;
        let other = texts[(kill as usize + 1) % 2].len() as u64;
        for length in [other, wanted] {
            while std::fs::metadata(&target).unwrap().len() != length {
                assert!(process.try_wait().unwrap().is_none(), "it ended by itself");
                std::thread::sleep(Duration::from_micros(100));
            }
        }
        // Any moment of a save, which takes some milliseconds: steps by a golden ratio fall everywhere.
        std::thread::sleep(Duration::from_micros(kill * 6_180 % 10_000));
        // Kills outright: nothing of the process gets to say a word.
        process.kill().unwrap();
        process.wait().unwrap();
        let there = std::fs::read_to_string(&target).unwrap();
        let which = texts.iter().position(|text| *text == there);
        seen[which.unwrap_or_else(|| panic!("after kill {kill} the file is neither text: {} bytes", there.len()))] += 1;
        let left = unfinished(folder.path());
        caught_at_work += left;
        assert!(left <= 1, "what earlier ones left was taken away by the next");
    }
    // Otherwise the kills came at the wrong moments, and nothing was tested.
    assert!(seen[0] > 0 && seen[1] > 0 && caught_at_work > 0, "{seen:?}, {caught_at_work} at work");
    file::save(&graphs[1].graph, &target).unwrap();
    assert_eq!(unfinished(folder.path()), 0);
}

use proptest::prelude::*;

use super::*;

const HEAD: &str =
    r#"<svg xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink" width="100" height="100">"#;

fn drawing(body: &str) -> Vec<Path2d> {
    read(format!("{HEAD}{body}</svg>").as_bytes(), 0.01).unwrap()
}

fn refusal(text: &str) -> String {
    read(text.as_bytes(), 0.1).unwrap_err().to_string()
}

fn points(path: &Path2d) -> Vec<[f64; 2]> {
    path.points.iter().map(|p| p.to_array()).collect()
}

#[test]
fn lines_keep_their_points_and_y_runs_down() {
    let paths = drawing(r#"<path id="arm" d="M 10 20 L 30 20 30 20 L 30 50" fill="none" stroke="red"/>"#);
    assert_eq!(paths.len(), 1);
    assert_eq!((paths[0].name.as_str(), paths[0].closed), ("arm", false));
    assert_eq!(points(&paths[0]), [[10.0, 20.0], [30.0, 20.0], [30.0, 50.0]]);
}

#[test]
fn closed_subpaths_do_not_repeat_their_first_point() {
    let paths = drawing(r#"<path d="M0 0H10V10Z"/><path d="M0 0H10V10L0 0"/><path d="M0 0H10V10H0V0Z"/>"#);
    assert_eq!(paths.iter().map(|p| (p.closed, p.points.len())).collect::<Vec<_>>(), [(true, 3), (true, 3), (true, 4)]);
    let line = drawing(r#"<path stroke="red" d="M0 0H10Z"/>"#);
    assert_eq!((line[0].closed, line[0].points.len()), (false, 2), "there and back is a line");
}

#[test]
fn subpaths_become_curves_of_their_own() {
    let paths = drawing(
        r#"<path id="eye" d="M0 0h9v9zm2 2h3v3zl-1 5 3 2" stroke="red"/><path d="M0 50h9v9"/><path d="M0 60h9v9"/>"#,
    );
    let found: Vec<_> = paths.iter().map(|p| (p.name.as_str(), p.closed, p.points.len())).collect();
    let expected =
        [("eye 0", true, 3), ("eye 1", true, 3), ("eye 2", false, 3), ("path 0", false, 3), ("path 1", false, 3)];
    assert_eq!(found, expected);
    assert_eq!(points(&paths[2]), [[2.0, 2.0], [1.0, 7.0], [4.0, 9.0]]);
}

#[test]
fn transforms_view_boxes_and_units_are_applied() {
    let text = r#"<svg xmlns="http://www.w3.org/2000/svg" width="1in" height="2in" viewBox="0 0 48 96">
        <g transform="translate(10 5)"><path id="a" transform="rotate(90) scale(2)" d="M1 0L1 3" stroke="red"/></g></svg>"#;
    let path = &read(text.as_bytes(), 0.1).unwrap()[0];
    // Two pixels a unit: (1, 0) goes to (0, 2) and by (10, 5); (1, 3) to (-6, 2) likewise.
    for (found, expected) in path.points.iter().zip([DVec2::new(20.0, 14.0), DVec2::new(8.0, 14.0)]) {
        assert!(found.distance(expected) < 1e-5, "{found} {expected}");
    }
}

#[test]
fn shapes_and_references_are_paths() {
    let paths = drawing(
        r##"<defs><path id="leaf" d="M0 0h2v2z"/></defs><use xlink:href="#leaf" x="5"/><rect id="box" x="1" y="2" width="3" height="4"/>
        <polyline id="edge" points="0,0 5,5 9,0" fill="none" stroke="red"/><line id="l" x2="7" stroke="red"/>"##,
    );
    let names: Vec<&str> = paths.iter().map(|p| p.name.as_str()).collect();
    assert_eq!(names[1..], ["box", "edge", "l"]);
    assert_eq!(points(&paths[0]), [[5.0, 0.0], [7.0, 0.0], [7.0, 2.0]]);
    assert_eq!((paths[1].closed, points(&paths[1])[2]), (true, [4.0, 6.0]));
    assert_eq!(points(&paths[3]), [[0.0, 0.0], [7.0, 0.0]]);
}

/// Largest distance of a densely sampled curve from a polyline.
fn deviation(curve: impl Fn(f64) -> DVec2, polyline: &[DVec2]) -> f64 {
    let distance = |p: DVec2| {
        polyline
            .windows(2)
            .map(|ends| {
                let along = ends[1] - ends[0];
                let t = ((p - ends[0]).dot(along) / along.length_squared()).clamp(0.0, 1.0);
                p.distance(ends[0] + t * along)
            })
            .fold(f64::INFINITY, f64::min)
    };
    (0..=2000).map(|k| distance(curve(f64::from(k) / 2000.0))).fold(0.0, f64::max)
}

#[test]
fn no_chord_lies_farther_off_than_the_tolerance() {
    let [a, b, c, d] = [[0.0, 0.0], [90.0, 10.0], [-40.0, 60.0], [80.0, 80.0]].map(DVec2::from);
    let cubic = |t: f64| a.lerp(b, t).lerp(b.lerp(c, t), t).lerp(b.lerp(c, t).lerp(c.lerp(d, t), t), t);
    let quadratic = |t: f64| a.lerp(b, t).lerp(b.lerp(c, t), t);
    let text = format!(
        r#"{HEAD}<path d="M0 0C90 10-40 60 80 80" stroke="red"/><path d="M0 0Q90 10-40 60" stroke="red"/></svg>"#
    );
    let mut counts = Vec::new();
    for tolerance in [3.0, 0.1, 0.001] {
        let paths = read(text.as_bytes(), tolerance).unwrap();
        for (found, least) in [(deviation(cubic, &paths[0].points), 0.2), (deviation(quadratic, &paths[1].points), 0.2)]
        {
            assert!(found <= tolerance + 1e-5, "{found} for {tolerance}");
            assert!(found >= least * tolerance, "{found} is wastefully fine for {tolerance}");
        }
        counts.push(paths[0].points.len());
    }
    assert!(counts[0] < counts[1] && counts[1] < counts[2], "{counts:?}");
}

#[test]
fn transformed_curves_keep_the_tolerance_in_pixels() {
    let text = format!(r#"{HEAD}<path transform="scale(20)" d="M0 0C1 0 0 4 4 4" stroke="red"/></svg>"#);
    let [a, b, c, d] = [[0.0, 0.0], [20.0, 0.0], [0.0, 80.0], [80.0, 80.0]].map(DVec2::from);
    let cubic = |t: f64| a.lerp(b, t).lerp(b.lerp(c, t), t).lerp(b.lerp(c, t).lerp(c.lerp(d, t), t), t);
    let found = deviation(cubic, &read(text.as_bytes(), 0.05).unwrap()[0].points);
    assert!((0.01..0.05001).contains(&found), "{found}");
}

#[test]
fn circles_and_arcs_are_round_to_3e_4_of_their_radius() {
    let paths = drawing(
        r#"<circle cx="50" cy="50" r="40"/><path d="M10 50A40 40 0 0 1 90 50" stroke="red"/><ellipse cx="50" cy="50" rx="40" ry="40"/>"#,
    );
    for path in &paths {
        for pair in path.points.windows(2) {
            for p in [pair[0], pair[0].midpoint(pair[1])] {
                let error = (p.distance(DVec2::splat(50.0)) - 40.0).abs();
                assert!(error < 3e-4 * 40.0 + 0.01, "{error}");
            }
        }
    }
    assert_eq!(paths.iter().map(|p| p.closed).collect::<Vec<_>>(), [true, false, true]);
}

#[test]
fn what_is_not_drawn_is_not_read() {
    let shown = r#"<path id="shown" d="M0 0h9v9" stroke="red"/>"#;
    let paths = drawing(&format!(
        r##"<defs><marker id="m"><path d="M0 0h1v1z"/></marker><clipPath id="c"><path d="M0 0h1v1z"/></clipPath></defs>
        <path id="marked" d="M0 0h9v9" stroke="red" marker-end="url(#m)" style="marker-start:url(#m)"/>
        <path d="M0 0h9v9" display="none"/><path d="M0 0h9v9" visibility="hidden"/><path d="M0 0h9v9" fill="none"/>
        <text x="1" y="9">text</text><image width="9" height="9" xlink:href="data:image/png;base64,AAAA"/>
        <image width="9" height="9" xlink:href="/etc/hostname"/><path d="M0 0"/><g clip-path="url(#c)">{shown}</g>"##
    ));
    assert_eq!(paths.iter().map(|p| p.name.as_str()).collect::<Vec<_>>(), ["marked", "shown"]);
}

#[test]
fn a_drawing_without_paths_says_what_is_missing() {
    let empty = format!("{HEAD}</svg>");
    let invisible = format!(r#"{HEAD}<path d="M0 0h9v9" fill="none"/></svg>"#);
    for text in [empty, invisible] {
        let message = refusal(&text);
        assert_eq!(
            message,
            "the SVG file holds no visible path: paths need a fill or a stroke, and text has to be turned into paths"
        );
    }
}

#[test]
fn tolerances_that_do_not_work_are_refused() {
    let text = format!(r#"{HEAD}<path d="M0 0C90 10-40 60 80 80" stroke="red"/></svg>"#);
    for tolerance in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let message = read(text.as_bytes(), tolerance).unwrap_err().to_string();
        assert!(message.contains("give a positive number of pixels"), "{message}");
    }
    for tolerance in [1e-12, 1e-300] {
        let message = read(text.as_bytes(), tolerance).unwrap_err().to_string();
        assert!(message.contains("more than a million points: give a larger one"), "{message}");
    }
}

#[test]
fn what_is_no_drawing_is_refused() {
    assert_eq!(read(b"", 0.1), Err(ReadError::Empty { format: "SVG" }));
    for text in ["<svg", "text", "<html></html>", "\0", "<svg xmlns=\"http://www.w3.org/2000/svg\"><g></svg>"] {
        assert!(matches!(read(text.as_bytes(), 0.1), Err(ReadError::Malformed { .. })), "{text}");
    }
    let message = read(b"<svg>\xff", 0.1).unwrap_err().to_string();
    assert!(message.contains("byte 5: not UTF-8"), "{message}");
    assert!(matches!(read(&[0x1f, 0x8b, 8, 0], 0.1), Err(ReadError::Unsupported { .. })));
    let broken = refusal(&format!("{HEAD}\n<path d=\n</svg>"));
    assert!(broken.contains("line 3") || broken.contains("line 2"), "{broken}");
}

#[test]
fn deep_nesting_is_read_to_its_limit_and_refused_beyond() {
    let nested = |depth: usize| {
        format!(r#"{HEAD}{}<path d="M0 0h9v9"/>{}</svg>"#, r#"<g opacity="0.5">"#.repeat(depth), "</g>".repeat(depth))
    };
    assert_eq!(read(nested(extent::MAX_DEPTH as usize - 2).as_bytes(), 0.1).unwrap().len(), 1);
    for depth in [extent::MAX_DEPTH as usize, 100_000] {
        assert!(refusal(&nested(depth)).contains("nested deeper than 256"));
    }
}

#[test]
fn references_that_multiply_or_chase_themselves_end() {
    let mut body = String::from(r#"<g id="a0"><path d="M0 0h9v9"/></g>"#);
    for level in 1..12 {
        let uses = format!(r##"<use xlink:href="#a{}"/>"##, level - 1).repeat(10);
        body.push_str(&format!(r#"<g id="a{level}">{uses}</g>"#));
    }
    assert!(read(format!("{HEAD}{body}</svg>").as_bytes(), 0.1).is_err());

    // Each link nests two groups deeper; the longest chain that is read must not exhaust the stack.
    for links in [100, 300, 340, 341, 500, 510, 2000] {
        let chain: String = (0..links)
            .map(|k| format!(r##"<g id="b{k}" opacity="0.5"><use xlink:href="#b{}"/></g>"##, k + 1))
            .collect();
        let found = read(format!(r#"{HEAD}{chain}<path id="b{links}" d="M0 0h9v9"/></svg>"#).as_bytes(), 0.1);
        assert!(if links == 100 { found.is_ok() } else { links < 2000 || found.is_err() }, "{links} links");
    }

    let circle = r##"<g id="x"><use xlink:href="#y"/></g><g id="y"><use xlink:href="#x"/></g>"##;
    assert!(matches!(read(format!("{HEAD}{circle}</svg>").as_bytes(), 0.1), Err(ReadError::Malformed { .. })));
    let laughs = format!(
        r#"<!DOCTYPE svg [<!ENTITY a "aaaaaaaaaa">{}]>{HEAD}<path id="&j;" d="M0 0h9v9"/></svg>"#,
        ('b'..='j')
            .map(|c| format!("<!ENTITY {c} \"{}\">", format!("&{};", char::from(c as u8 - 1)).repeat(10)))
            .collect::<String>()
    );
    assert!(matches!(read(laughs.as_bytes(), 0.1), Err(ReadError::Malformed { .. })));
}

#[test]
fn a_file_cut_off_anywhere_is_refused() {
    let text = format!(r#"{HEAD}<g id="b"><path d="M0 0C9 9 3 3 1 1z"/></g></svg>"#);
    for length in 0..text.len() {
        assert!(read(&text.as_bytes()[..length], 0.1).is_err());
    }
}

proptest! {
    #[test]
    fn random_paths_never_panic(
        d in "M[-0-9 ]{3,8}([MLHVCSQTAZmlhvcsqtaz] ?([-0-9e. ]{1,9},?){1,7}){0,12}",
        transform in "(scale|rotate|translate|matrix|skewX)\\([-0-9e. ]{1,12}\\)",
        bytes in proptest::collection::vec(any::<u8>(), 0..100),
    ) {
        prop_assert!(read(&bytes, 0.1).is_err());
        let text = format!(r#"{HEAD}<path d="{d}" transform="{transform}" stroke="red"/></svg>"#);
        for path in read(text.as_bytes(), 0.1).unwrap_or_default() {
            prop_assert!(path.points.len() >= 2 + usize::from(path.closed));
            prop_assert!(path.points.iter().all(|p| p.is_finite()));
            prop_assert!(path.points.windows(2).all(|pair| pair[0] != pair[1]));
        }
    }
}

//! The contact sheet: a small picture of each variant with its values below, all from one camera.

use glam::DVec3;

use super::Arguments;
use super::row::{Row, State};
use super::runner::Runner;
use super::variants::Variants;
use crate::picture::lettering::Lettering;
use crate::picture::{MAX_SIDE, Picture, PictureError, PictureOptions, draw_within};

/// Space around the sheet, pixels.
const MARGIN: usize = 24;
/// Space between pictures, pixels.
const GAP: usize = 16;
/// Space between a picture and its caption, and between its lines.
const LEADING: usize = 4;
/// Width over height that a sheet in no particular order comes near to.
const SHAPE: f64 = 1.5;
/// More columns than these are not put side by side for the sake of order.
const MOST_COLUMNS: usize = 16;

const PAPER: [u8; 3] = [250, 250, 251];
const FAILED_PAPER: [u8; 3] = [243, 234, 232];
const INK: [u8; 3] = [28, 30, 34];
const PALE: [u8; 3] = [112, 116, 124];
const FAINT: [u8; 3] = [140, 144, 152];
const ALARM: [u8; 3] = [176, 44, 32];

/// Where everything on a sheet stands.
pub(super) struct Layout {
    columns: usize,
    tile: [usize; 2],
    caption_lines: usize,
    head: usize,
    /// Width and height of the sheet, pixels.
    size: [usize; 2],
    /// What an address is called in captions.
    labels: Vec<String>,
}

impl Layout {
    /// The layout of all variants, with pictures of `tile` pixels.
    pub(super) fn new(variants: &Variants, tile: (u32, u32)) -> Result<Self, String> {
        let (width, height) = (tile.0 as usize, tile.1 as usize);
        let fail = |what: String| format!("error: --sheet: {what}");
        if width < 64 || height < 48 || tile.0 > MAX_SIDE || tile.1 > MAX_SIDE {
            return Err(fail(format!("a --tile is 64x48 to {MAX_SIDE}x{MAX_SIDE} pixels")));
        }
        let labels = labels(variants);
        let mut layout = Self { columns: 1, tile: [width, height], caption_lines: 1, head: 0, size: [0, 0], labels };
        let lines = (0..variants.len()).map(|variant| layout.caption(variants, variant).len());
        layout.caption_lines = lines.max().unwrap_or(1);
        let count = variants.len().max(1);
        let pitch = layout.pitch();
        let even = (count as f64 * SHAPE * pitch[1] as f64 / pitch[0] as f64).sqrt().round().max(1.0) as usize;
        // Rows that begin with the same values are easier to compare than a good shape is worth.
        let apart = |columns: &usize| (columns.max(&even) * 100) / columns.min(&even).max(&1);
        let in_order = variants.periods().into_iter().filter(|columns| (2..=MOST_COLUMNS).contains(columns));
        layout.columns = in_order.min_by_key(apart).unwrap_or(even).min(count);
        layout.head = Lettering::Heading.height() + LEADING + Lettering::Caption.height() + GAP;
        let rows = count.div_ceil(layout.columns);
        let side = |count: usize, pitch: usize| (count.saturating_mul(pitch)).saturating_sub(GAP) + 2 * MARGIN;
        layout.size = [side(layout.columns, pitch[0]), side(rows, pitch[1]) + layout.head];
        if layout.size.iter().any(|side| *side > MAX_SIDE as usize) {
            let [width, height] = layout.size;
            return Err(fail(format!(
                "{count} pictures would make a sheet of {width}x{height} pixels, and {MAX_SIDE} a side are the most: \
                 choose a smaller --tile or vary less"
            )));
        }
        Ok(layout)
    }

    /// From one picture to the next.
    fn pitch(&self) -> [usize; 2] {
        let line = Lettering::Caption.height() + LEADING;
        [self.tile[0] + GAP, self.tile[1] + LEADING + self.caption_lines * line + GAP]
    }

    /// Upper left corner of a picture.
    fn place(&self, variant: usize) -> [usize; 2] {
        let (column, row, pitch) = (variant % self.columns, variant / self.columns, self.pitch());
        [MARGIN + column * pitch[0], MARGIN + self.head + row * pitch[1]]
    }

    /// The lines of a caption: addresses with values, as many on a line as fit.
    fn caption(&self, variants: &Variants, variant: usize) -> Vec<Vec<[String; 2]>> {
        let room = self.tile[0] / Lettering::Caption.advance();
        let mut lines: Vec<Vec<[String; 2]>> = Vec::new();
        let mut used = 0;
        for (label, (_, value)) in self.labels.iter().zip(variants.values(variant)) {
            let length = label.chars().count() + 1 + value.text.chars().count();
            match lines.last_mut() {
                Some(line) if used + 3 + length <= room => {
                    used += 3 + length;
                    line.push([label.clone(), value.text.clone()]);
                }
                _ => {
                    used = length;
                    lines.push(vec![[label.clone(), value.text.clone()]]);
                }
            }
        }
        lines
    }
}

/// The port alone where no other address ends in the same.
fn labels(variants: &Variants) -> Vec<String> {
    let short = |address: &str| address.rsplit_once('.').map_or(address, |(_, port)| port).to_owned();
    let addresses: Vec<&str> = variants.axes.iter().map(|axis| axis.address.as_str()).collect();
    let label = |address: &&str| {
        let alone = addresses.iter().filter(|other| short(other) == short(address)).count() == 1;
        if alone { short(address) } else { (*address).to_owned() }
    };
    addresses.iter().map(label).collect()
}

/// Draws the sheet as PNG; `None` where the wedge was stopped, or nothing came out that can be drawn.
pub(super) fn draw(arguments: &Arguments, runner: &mut Runner<'_>, rows: &[Row]) -> Result<Option<Vec<u8>>, String> {
    let layout = Layout::new(&runner.plan.variants, arguments.tile)?;
    let boxes = rows.iter().filter(|row| is_drawn(row)).filter_map(Row::bounds);
    let Some(frame) = boxes.reduce(|a, b| [a[0].min(b[0]), a[1].max(b[1])]) else {
        return Err("--sheet: no variant has anything to draw, so there is no sheet".to_owned());
    };
    let [width, height] = layout.size;
    let mut sheet = blank(width, height, PAPER);
    head(&mut sheet, &layout, runner, rows);
    for variant in runner.plan.variants.cheapest_order(&runner.plan.costs()) {
        let row = &rows[variant];
        let tile =
            if is_drawn(row) { picture(arguments, runner, variant, row, frame)? } else { Some(failed(&layout, row)) };
        let Some(tile) = tile else { return Ok(None) };
        let place = layout.place(variant);
        copy(&mut sheet, &tile, place);
        label(&mut sheet, &layout, runner, variant, row);
    }
    sheet.to_png().map(Some).map_err(|error| format!("--sheet: {error}"))
}

/// Whether there is something to draw, to the last node.
fn is_drawn(row: &Row) -> bool {
    matches!(row.state, State::Done | State::Kept | State::Exceeded | State::NotWritten) && row.bounds().is_some()
}

fn blank(width: usize, height: usize, colour: [u8; 3]) -> Picture {
    let rgb = colour.iter().copied().cycle().take(width * height * 3).collect();
    Picture { width: width as u32, height: height as u32, rgb }
}

fn picture(
    arguments: &Arguments,
    runner: &mut Runner<'_>,
    variant: usize,
    row: &Row,
    frame: [DVec3; 2],
) -> Result<Option<Picture>, String> {
    let Some(scene) = runner.scene(variant)? else { return Ok(None) };
    let (width, height) = arguments.tile;
    let view = arguments.view.view();
    let options = PictureOptions { view, width, height, wireframe: false, curves: !row.has_mesh() };
    let fail = |error: PictureError| format!("--sheet: variant {}: {error}", variant + 1);
    draw_within(&scene, &options, frame).map(Some).map_err(fail)
}

/// In place of a picture: why there is none.
fn failed(layout: &Layout, row: &Row) -> Picture {
    let [width, height] = layout.tile;
    let mut tile = blank(width, height, FAILED_PAPER);
    let pad = 12;
    let room = ((width - 2 * pad) / Lettering::Caption.advance()).max(1);
    let line = Lettering::Caption.height() + LEADING;
    let word = if row.state == State::Failed { "failed" } else { "nothing to draw" };
    let top = height / 4;
    Lettering::Strong.write(&mut tile, [pad, top], word, ALARM);
    let reason = row.errors.first().map_or("", |error| error.split_once("error: ").map_or(error.as_str(), |(_, r)| r));
    let letters: Vec<char> = reason.chars().collect();
    let most = (height - top) / line;
    for (place, piece) in wrapped(&letters, room).into_iter().take(most.saturating_sub(2)).enumerate() {
        Lettering::Caption.write(&mut tile, [pad, top + (place + 1) * line], &piece, PALE);
    }
    tile
}

/// A text in lines of at most `room` letters, broken at spaces where there are any.
fn wrapped(letters: &[char], room: usize) -> Vec<String> {
    let mut lines = Vec::new();
    let mut rest = letters;
    while rest.len() > room {
        let at = rest[..=room].iter().rposition(|letter| *letter == ' ').filter(|at| *at > 0).unwrap_or(room);
        lines.push(rest[..at].iter().collect());
        rest = &rest[at..];
        rest = rest.strip_prefix(&[' ']).unwrap_or(rest);
    }
    lines.push(rest.iter().collect());
    lines
}

fn copy(sheet: &mut Picture, tile: &Picture, [left, top]: [usize; 2]) {
    let (width, tile_width) = (sheet.width as usize, tile.width as usize * 3);
    for (row, pixels) in tile.rgb.chunks_exact(tile_width).enumerate() {
        let at = ((top + row) * width + left) * 3;
        if let Some(place) = sheet.rgb.get_mut(at..at + tile_width) {
            place.copy_from_slice(pixels);
        }
    }
}

fn head(sheet: &mut Picture, layout: &Layout, runner: &Runner<'_>, rows: &[Row]) {
    let room = layout.size[0] - 2 * MARGIN;
    let path = &runner.plan.file.path;
    let name = path.file_stem().map_or_else(String::new, |stem| stem.to_string_lossy().into_owned());
    Lettering::Heading.write(sheet, [MARGIN, MARGIN], &Lettering::Heading.fitted(&name, room), INK);
    let axes = &runner.plan.variants.axes;
    let groups = runner
        .plan
        .variants
        .groups
        .iter()
        .map(|group| group.iter().map(|axis| axes[*axis].address.as_str()).collect::<Vec<_>>().join(" + "));
    let bad = rows.iter().filter(|row| matches!(row.state, State::Failed | State::Exceeded)).count();
    let bad = if bad > 0 { format!(" \u{b7} {bad} failed") } else { String::new() };
    let text = format!("{} variants{bad} \u{b7} {}", rows.len(), groups.collect::<Vec<_>>().join(" \u{d7} "));
    let top = MARGIN + Lettering::Heading.height() + LEADING;
    Lettering::Caption.write(sheet, [MARGIN, top], &Lettering::Caption.fitted(&text, room), PALE);
}

fn label(sheet: &mut Picture, layout: &Layout, runner: &Runner<'_>, variant: usize, row: &Row) {
    let [left, top] = layout.place(variant);
    let [width, height] = layout.tile;
    let letter = Lettering::Caption.advance();
    Lettering::Caption.write(sheet, [left + 8, top + 6], &(variant + 1).to_string(), FAINT);
    if row.state == State::Exceeded {
        let word = "over the limit";
        let at = (left + width).saturating_sub(Lettering::Strong.width(word) + 8);
        Lettering::Strong.write(sheet, [at, top + 6], word, ALARM);
    }
    for (place, line) in layout.caption(&runner.plan.variants, variant).into_iter().enumerate() {
        let y = top + height + LEADING + place * (Lettering::Caption.height() + LEADING);
        let mut x = left;
        for [name, value] in line {
            let name = Lettering::Caption.fitted(&name, (left + width).saturating_sub(x + 4 * letter));
            Lettering::Caption.write(sheet, [x, y], &name, PALE);
            x += (name.chars().count() + 1) * letter;
            let value = Lettering::Strong.fitted(&value, (left + width).saturating_sub(x));
            Lettering::Strong.write(sheet, [x, y], &value, INK);
            x += (value.chars().count() + 3) * letter;
        }
    }
}

#[cfg(test)]
mod tests {
    use maquette_graph::Graph;

    use super::super::values::Vary;
    use super::super::variants::Combining;
    use super::*;

    fn variants(varies: &[&str]) -> Variants {
        let catalogue = maquette_nodes::catalogue().unwrap();
        let mut graph = Graph::new();
        for name in ["body", "other"] {
            graph.add(&catalogue, "detail-generator", name).unwrap();
        }
        let varies = varies.iter().map(|text| Vary::parse(&mut graph, text).unwrap()).collect();
        Variants::new(varies, &Combining::default()).unwrap()
    }

    #[test]
    fn two_addresses_make_rows_and_columns() {
        let layout = Layout::new(&variants(&["body.k_s=1..2:3", "body.k_b=1..2:4"]), (320, 240)).unwrap();
        assert_eq!((layout.columns, layout.size[0]), (4, 4 * 320 + 3 * GAP + 2 * MARGIN));
        assert_eq!(layout.place(5)[0], layout.place(1)[0]);
        let layout = Layout::new(&variants(&["body.k_s=1..2:12"]), (320, 240)).unwrap();
        assert_eq!(layout.columns, 4);
        let three = ["body.k_s=1..2:4", "body.k_b=1,2", "other.k_s=1,2"];
        assert_eq!(Layout::new(&variants(&three), (280, 320)).unwrap().columns, 4);
    }

    #[test]
    fn captions_are_short_where_that_is_clear_and_fit_the_picture() {
        let one = variants(&["body.k_s=1,2", "body.k_b=1,2"]);
        assert_eq!(labels(&one), ["k_s", "k_b"]);
        let both = variants(&["body.k_s=1,2", "other.k_s=1,2"]);
        assert_eq!(labels(&both), ["body.k_s", "other.k_s"]);
        assert_eq!(Layout::new(&one, (320, 240)).unwrap().caption_lines, 1);
        assert_eq!(Layout::new(&both, (100, 80)).unwrap().caption_lines, 2);
    }

    #[test]
    fn a_sheet_beyond_all_screens_is_refused() {
        let error = Layout::new(&variants(&["body.k_s=1..2:9000"]), (320, 240)).err().unwrap();
        assert!(error.contains("9000 pictures would make a sheet of") && error.contains("smaller --tile"), "{error}");
        assert!(Layout::new(&variants(&["body.k_s=1,2"]), (10, 10)).err().unwrap().contains("64x48"));
    }

    #[test]
    fn texts_break_at_spaces() {
        let lines = |text: &str, room| wrapped(&text.chars().collect::<Vec<_>>(), room);
        assert_eq!(lines("give two or more", 8), ["give two", "or more"]);
        assert_eq!(lines("abcdefghij kl", 4), ["abcd", "efgh", "ij", "kl"]);
    }
}

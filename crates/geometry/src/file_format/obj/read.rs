//! OBJ into meshes.

use std::collections::BTreeMap;

use glam::{DVec2, DVec3};

use super::FORMAT;
use crate::file_format::ReadError;
use crate::file_format::pace::Pace;
use crate::mesh::measure::vector_area;
use crate::mesh::{FaceNames, Mesh, NamedBy};

/// The polygons of an OBJ, one mesh an object (`o`; one for all where the file has no objects), in the file's order.
///
/// Groups (`g`, from one object to the next) and names of materials (`usemtl`) are kept at the polygons, where a mesh has
/// any.
/// Polygons keep their corners. Vertices keep their order; those no polygon uses are left out. Normals (brought to unit
/// length; the polygon's own where one is zero) and UVs are kept where every corner of the object has one. Relative
/// indices and continued lines are understood; material libraries, lines, points, vertex colours and free-form surfaces are
/// ignored. Bytes that are not UTF-8 are no error: they can only be part of names and comments.
///
/// # Errors
/// [`ReadError`] where the file is empty or has no polygon, and, with the number of the line, where a number or index
/// is wrong.
pub fn read(bytes: &[u8]) -> Result<Vec<Mesh>, ReadError> {
    read_while(bytes, &|_| true)
}

/// The same, calling `progress` with the fraction done.
///
/// # Errors
/// As [`read`], and [`ReadError::Stopped`] where `progress` answers `false`.
pub fn read_while(bytes: &[u8], progress: &dyn Fn(f64) -> bool) -> Result<Vec<Mesh>, ReadError> {
    if bytes.is_empty() {
        return Err(ReadError::Empty { format: FORMAT });
    }
    let text = String::from_utf8_lossy(bytes);
    let mut pace = Pace::new(progress, 2 * bytes.len(), BYTES);
    pace.at(0)?;
    let mut read = 0;
    let mut file = File::default();
    let mut continued = String::new();
    let mut first_line = 1;
    for (index, line) in text.lines().enumerate() {
        pace.at(read)?;
        read += line.len() + 1;
        if continued.is_empty() {
            first_line = index + 1;
        }
        let trimmed = line.trim_end();
        if let Some(start) = trimmed.strip_suffix('\\') {
            continued.push_str(start);
            continued.push(' ');
            continue;
        }
        if continued.is_empty() {
            file.take(trimmed, first_line)?;
        } else {
            continued.push_str(trimmed);
            file.take(&continued, first_line)?;
            continued.clear();
        }
    }
    if !continued.is_empty() {
        file.take(&continued, first_line)?;
    }
    let whole: usize = file.objects.iter().map(|object| object.corners.len()).sum();
    let mut pace = Pace::new(progress, 2 * whole, CORNERS);
    let mut done = whole;
    let mut used = Used::new(file.positions.len());
    let mut meshes = Vec::new();
    for object in file.objects.iter().filter(|object| !object.lines.is_empty()) {
        meshes.push(file.mesh(object, &mut used, &mut |corners| pace.at(done + corners))?);
        done += object.corners.len();
    }
    if meshes.is_empty() {
        return Err(ReadError::Nothing {
            format: FORMAT,
            what: "polygon",
            remedy: "it needs lines that begin with f; export the object as a mesh",
        });
    }
    Ok(meshes)
}

/// Bytes of text between two questions whether to go on.
const BYTES: usize = 1 << 18;

/// Corners between two questions whether to go on.
const CORNERS: usize = 1 << 16;

/// Which vertices of the file an object uses, and their places among them.
struct Used {
    /// The number of the object that used the vertex last.
    stamps: Vec<u32>,
    places: Vec<u32>,
    object: u32,
}

impl Used {
    fn new(vertices: usize) -> Self {
        Self { stamps: vec![0; vertices], places: vec![0; vertices], object: 0 }
    }

    /// The vertices of these corners in the order of the file; their places are known from then on.
    fn vertices(&mut self, corners: &[Corner]) -> Vec<usize> {
        // There are no more objects than lines, and no more lines than bytes.
        self.object = self.object.wrapping_add(1);
        let mut vertices = Vec::new();
        for corner in corners {
            if std::mem::replace(&mut self.stamps[corner.vertex], self.object) != self.object {
                vertices.push(corner.vertex);
            }
        }
        vertices.sort_unstable();
        for (place, vertex) in vertices.iter().enumerate() {
            self.places[*vertex] = place as u32;
        }
        vertices
    }
}

/// Indices of a corner into the file's vertices, UVs and normals, from 0.
#[derive(Clone, Copy)]
struct Corner {
    vertex: usize,
    uv: Option<usize>,
    normal: Option<usize>,
}

#[derive(Default)]
struct Object {
    name: String,
    corners: Vec<Corner>,
    /// Behind the last corner of each polygon.
    ends: Vec<usize>,
    /// The line of each polygon.
    lines: Vec<usize>,
    /// The places of each polygon's group and material in the file's list of names.
    names: Vec<[u32; 2]>,
}

#[derive(Default)]
struct File {
    /// Groups and materials, the empty name first.
    names: Vec<String>,
    known: BTreeMap<String, u32>,
    /// Group and material at this place of the file.
    current: [u32; 2],
    positions: Vec<DVec3>,
    uvs: Vec<DVec2>,
    normals: Vec<DVec3>,
    objects: Vec<Object>,
}

fn malformed(line: usize, problem: impl Into<String>) -> ReadError {
    ReadError::Malformed { format: FORMAT, place: format!("line {line}"), problem: problem.into() }
}

impl File {
    fn take(&mut self, text: &str, line: usize) -> Result<(), ReadError> {
        let mut words = text.split_whitespace();
        match words.next() {
            Some("v") => {
                let position = self.numbers(words, line, 3)?;
                self.positions.push(position.into());
            }
            Some("vt") => {
                // The second coordinate may be left out.
                let [u, v, _] = self.numbers(words, line, 1)?;
                self.uvs.push(DVec2::new(u, v));
            }
            Some("vn") => {
                let normal = self.numbers(words, line, 3)?;
                self.normals.push(normal.into());
            }
            Some("f") => self.take_polygon(words, line)?,
            Some("o") => self.begin_object(text),
            Some("g") => self.current[0] = self.name(behind(text, "g")),
            Some("usemtl") => self.current[1] = self.name(behind(text, "usemtl")),
            _ => {}
        }
        Ok(())
    }

    fn begin_object(&mut self, text: &str) {
        self.current[0] = 0;
        self.objects.push(Object { name: behind(text, "o").to_owned(), ..Object::default() });
    }

    /// The place of a name in the list.
    fn name(&mut self, name: &str) -> u32 {
        if self.names.is_empty() {
            self.names.push(String::new());
            self.known.insert(String::new(), 0);
        }
        if let Some(place) = self.known.get(name) {
            return *place;
        }
        // There are no more names than bytes in the file, and no more of these than 32 bits count.
        let place = self.names.len() as u32;
        self.names.push(name.to_owned());
        self.known.insert(name.to_owned(), place);
        place
    }

    /// The first three numbers of a line; `needed` of them must be there, the others are 0 by default.
    fn numbers<'a>(
        &self,
        words: impl Iterator<Item = &'a str>,
        line: usize,
        needed: usize,
    ) -> Result<[f64; 3], ReadError> {
        let mut numbers = [0.0_f64; 3];
        let mut found = 0;
        for (number, word) in numbers.iter_mut().zip(words) {
            *number = word
                .parse()
                .map_err(|_| malformed(line, format!("\"{}\" stands where a number is expected", shortened(word))))?;
            found += 1;
        }
        if found < needed {
            return Err(malformed(line, format!("{found} number(s) where {needed} are expected")));
        }
        if numbers.iter().any(|number| !number.is_finite()) {
            let name = self.objects.last().map_or("", |object| &object.name).to_owned();
            return Err(ReadError::NotFinite { format: FORMAT, name, what: "line", index: line });
        }
        Ok(numbers)
    }

    fn take_polygon<'a>(&mut self, words: impl Iterator<Item = &'a str>, line: usize) -> Result<(), ReadError> {
        let counts = [self.positions.len(), self.uvs.len(), self.normals.len()];
        if self.objects.is_empty() {
            self.objects.push(Object { name: "object".to_owned(), ..Object::default() });
        }
        let Some(object) = self.objects.last_mut() else { return Ok(()) };
        let before = object.corners.len();
        for word in words {
            object.corners.push(corner(word, counts, line)?);
        }
        let found = object.corners.len() - before;
        if found < 3 {
            return Err(malformed(line, format!("a polygon of {found} corner(s); it needs at least 3")));
        }
        object.ends.push(object.corners.len());
        object.lines.push(line);
        object.names.push(self.current);
        Ok(())
    }

    /// `pace` is told how many corners are done.
    fn mesh(
        &self,
        object: &Object,
        used: &mut Used,
        pace: &mut dyn FnMut(usize) -> Result<(), ReadError>,
    ) -> Result<Mesh, ReadError> {
        let starts = std::iter::once(0).chain(object.ends.iter().copied());
        let polygons = || starts.clone().zip(object.ends.iter().copied()).map(|(start, end)| start..end);

        for (polygon, &line) in polygons().zip(&object.lines) {
            pace(polygon.start / 2)?;
            for corner in &object.corners[polygon] {
                check_index("vertex", corner.vertex, self.positions.len(), line)?;
                check_index("UV", corner.uv.unwrap_or(0), corner.uv.map_or(1, |_| self.uvs.len()), line)?;
                check_index(
                    "normal",
                    corner.normal.unwrap_or(0),
                    corner.normal.map_or(1, |_| self.normals.len()),
                    line,
                )?;
            }
        }

        let vertices = used.vertices(&object.corners);
        pace(object.corners.len() / 2)?;
        let positions: Vec<DVec3> = vertices.iter().map(|&vertex| self.positions[vertex]).collect();
        let corners: Vec<u32> = object.corners.iter().map(|corner| used.places[corner.vertex]).collect();
        pace(object.corners.len() * 3 / 4)?;
        let counts = polygons().map(|polygon| polygon.len());
        let failed = |source| ReadError::Mesh { name: object.name.clone(), source };
        let mut mesh = Mesh::from_corners(positions, corners, counts).map_err(failed)?.named(&object.name);

        for (kind, by) in NamedBy::ALL.into_iter().enumerate() {
            if object.names.iter().any(|names| names[kind] != 0) {
                let names = object.names.iter().map(|names| self.names[names[kind] as usize].as_str());
                mesh = mesh.with_names(by, FaceNames::new(names)).map_err(failed)?;
            }
        }
        let uvs: Option<Vec<DVec2>> = object.corners.iter().map(|corner| Some(self.uvs[corner.uv?])).collect();
        if let Some(uvs) = uvs {
            mesh = mesh.with_uvs(uvs).map_err(failed)?;
        }
        if object.corners.iter().all(|corner| corner.normal.is_some()) {
            let mut normals = Vec::with_capacity(object.corners.len());
            for polygon in polygons() {
                pace((object.corners.len() + polygon.start) / 2)?;
                let mut known = None;
                let mut own = || {
                    let corners = object.corners[polygon.clone()].iter().map(|c| self.positions[c.vertex]);
                    // Once for all corners of a polygon, which may be many.
                    *known.get_or_insert_with(|| vector_area(corners).try_normalize().unwrap_or(DVec3::Y))
                };
                for corner in &object.corners[polygon.clone()] {
                    let given = corner.normal.map_or(DVec3::ZERO, |normal| self.normals[normal]);
                    normals.push(given.try_normalize().unwrap_or_else(&mut own));
                }
            }
            mesh = mesh.with_normals(normals).map_err(failed)?;
        }
        Ok(mesh)
    }
}

fn check_index(what: &str, index: usize, count: usize, line: usize) -> Result<(), ReadError> {
    if index < count {
        return Ok(());
    }
    Err(malformed(line, format!("{what} {} is used, but the file has only {count}", index.saturating_add(1))))
}

/// What stands behind the keyword of a line.
fn behind<'a>(text: &'a str, keyword: &str) -> &'a str {
    text.trim_start().strip_prefix(keyword).unwrap_or("").trim()
}

/// A corner such as `7`, `7/3`, `7//2` or `7/3/2`; negative indices count back from the last entry so far.
fn corner(word: &str, counts: [usize; 3], line: usize) -> Result<Corner, ReadError> {
    let wrong = |problem: &str| malformed(line, format!("\"{}\" {problem}", shortened(word)));
    let mut indices = [None; 3];
    for (part, text) in word.split('/').enumerate() {
        let Some(index) = indices.get_mut(part) else {
            return Err(wrong("is no corner: expected vertex, vertex/uv, vertex//normal or vertex/uv/normal"));
        };
        if text.is_empty() && part > 0 {
            continue;
        }
        let number: i64 = text.parse().map_err(|_| wrong("is no corner: expected whole numbers such as 7/3/2"))?;
        *index = match number {
            0 => return Err(wrong("has index 0: OBJ counts from 1")),
            1.. => Some(usize::try_from(number - 1).unwrap_or(usize::MAX)),
            _ => {
                let back = usize::try_from(number.unsigned_abs()).unwrap_or(usize::MAX);
                Some(counts[part].checked_sub(back).ok_or_else(|| wrong("counts back beyond the first entry"))?)
            }
        };
    }
    let [Some(vertex), uv, normal] = indices else { return Err(wrong("names no vertex")) };
    Ok(Corner { vertex, uv, normal })
}

/// The beginning of a word, so that a message about a damaged file stays readable.
fn shortened(word: &str) -> String {
    let mut text: String = word.chars().take(24).collect();
    if text.len() < word.len() {
        text.push_str("..");
    }
    text
}

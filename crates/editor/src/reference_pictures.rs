//! The files of reference pictures, as textures. They are read and decoded on threads of their own, so that the window never
//! waits for a photograph.

use std::collections::BTreeMap;
use std::io::Read as _;
use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, TryRecvError, channel};
use std::time::SystemTime;

use egui::{ColorImage, TextureHandle, TextureOptions};
use maquette_geometry::file_format::picture;
use maquette_graph::file::Project;

use crate::document::Document;

/// Longest edge that is kept, pixels: more than any window shows.
const MOST_PIXELS: u32 = 4096;
/// Longest file that is read, bytes.
const MOST_BYTES: u64 = 256 << 20;
/// How often the window looks whether a file changed, seconds.
const LOOK: f64 = 2.0;

/// What became of a picture's file.
#[derive(Clone)]
pub(crate) enum PictureState {
    /// It is read.
    Loading,
    /// It can be drawn.
    Ready(TextureHandle),
    /// Why it can't be, in words.
    Failed(String),
}

struct Entry {
    written: Option<SystemTime>,
    coming: Option<Receiver<Result<ColorImage, String>>>,
    state: PictureState,
}

/// The pictures that the document names.
#[derive(Default)]
pub(crate) struct ReferencePictures {
    known: BTreeMap<PathBuf, Entry>,
    looked: f64,
}

impl ReferencePictures {
    /// How it stands with a picture of the document; `None` for one that was named in this very frame.
    pub(crate) fn state(&self, document: &Document, file: &str) -> Option<&PictureState> {
        Some(&self.known.get(&document.folder().join(file))?.state)
    }

    /// Whether some are still read.
    pub(crate) fn is_busy(&self) -> bool {
        self.known.values().any(|entry| entry.coming.is_some())
    }

    /// Begins to read what the document names anew or what changed on the disk, takes over what is read, and forgets what is
    /// no longer named.
    pub(crate) fn update(&mut self, context: &egui::Context, document: &Document) {
        let references = document.graph().references();
        if references.is_empty() {
            self.known.clear();
            return;
        }
        let now = context.input(|i| i.time);
        let looks = now - self.looked >= LOOK;
        if looks {
            self.looked = now;
        }
        let wanted: Vec<PathBuf> = references.iter().map(|picture| document.folder().join(&picture.file)).collect();
        self.known.retain(|path, _| wanted.contains(path));
        for path in wanted {
            let is_known = self.known.contains_key(&path);
            if is_known && !looks {
                continue;
            }
            let written = std::fs::metadata(&path).and_then(|data| data.modified()).ok();
            if self.known.get(&path).is_none_or(|entry| entry.written != written) {
                let coming = begin(context, path.clone(), document.project());
                let before = self.known.remove(&path).map(|entry| entry.state);
                let state = before.unwrap_or(PictureState::Loading);
                self.known.insert(path, Entry { written, coming, state });
            }
        }
        for (path, entry) in &mut self.known {
            let answer = match entry.coming.as_ref().map(Receiver::try_recv) {
                None | Some(Err(TryRecvError::Empty)) => continue,
                Some(Err(TryRecvError::Disconnected)) => Err("it can't be read: no thread could be started".to_owned()),
                Some(Ok(answer)) => answer,
            };
            entry.coming = None;
            entry.state = match answer {
                Ok(image) => {
                    let name = path.to_string_lossy();
                    PictureState::Ready(context.load_texture(name, image, TextureOptions::LINEAR))
                }
                Err(problem) => PictureState::Failed(problem),
            };
        }
    }
}

/// Reads a picture on a thread of its own.
fn begin(context: &egui::Context, path: PathBuf, project: Project) -> Option<Receiver<Result<ColorImage, String>>> {
    let (sender, receiver) = channel();
    let context = context.clone();
    let work = move || {
        // Nobody may listen any more.
        drop(sender.send(load(&path, &project)));
        context.request_repaint();
    };
    // Without a thread the sender is gone, and the receiver says so.
    drop(std::thread::Builder::new().name("reference picture".to_owned()).spawn(work));
    Some(receiver)
}

fn load(path: &Path, project: &Project) -> Result<ColorImage, String> {
    project.check(path).map_err(|outside| outside.to_string())?;
    let fail = |error: std::io::Error| match error.kind() {
        std::io::ErrorKind::NotFound => {
            format!("there is no file {}: choose another one, or bring it back", path.display())
        }
        _ => format!("{} can't be read: {error}", path.display()),
    };
    if !std::fs::metadata(path).map_err(fail)?.is_file() {
        return Err(format!("{} is not a file", path.display()));
    }
    let mut bytes = Vec::new();
    std::fs::File::open(path).map_err(fail)?.take(MOST_BYTES).read_to_end(&mut bytes).map_err(fail)?;
    let pixels = picture::pixels(&bytes, MOST_PIXELS).map_err(|error| format!("{}: {error}", path.display()))?;
    Ok(ColorImage::from_rgba_unmultiplied([pixels.width, pixels.height], &pixels.rgba))
}

//! A fuzzer for readers: takes what they read, damages it at random, and holds them to their promises: no panic, no hang,
//! no more memory than agreed. It runs on stable Rust as a test; what it finds is kept as a case that is tested for ever.
//!
//! `cargo test` tries a few thousand inputs, always the same ones. `MAQUETTE_FUZZ_SECONDS=600 cargo test fuzz` tries new
//! ones for ten minutes each and prints where it puts an input that breaks a promise.
#![allow(dead_code, reason = "each test file takes what it needs")]
#![allow(
    clippy::print_stdout,
    clippy::print_stderr,
    reason = "what a long run found is read by the one who started it"
)]

use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant, SystemTime};

use peak_alloc::PeakAlloc;

/// Longest time an input may take. Far more than any takes: it tells a hang, not a slow machine.
const HANG: Duration = Duration::from_secs(20);

/// Inputs of a plain `cargo test`.
const INPUTS: u64 = 1_500;

/// The allocator is one for all, so that only one test may measure at a time.
static ONE_AT_A_TIME: Mutex<()> = Mutex::new(());

fn alone() -> MutexGuard<'static, ()> {
    ONE_AT_A_TIME.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Numbers that are the same on every run (SplitMix64).
pub struct Dice(pub u64);

impl Dice {
    fn roll(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// A number below `bound`, which is not 0.
    pub fn below(&mut self, bound: usize) -> usize {
        usize::try_from(self.roll() % bound as u64).unwrap()
    }

    fn range(&mut self, length: usize, most: usize) -> std::ops::Range<usize> {
        let start = self.below(length + 1);
        let end = (start + self.below(most + 1)).min(length);
        start..end
    }
}

/// What is fuzzed.
pub struct Subject<'a> {
    /// For the name of the file that an input is kept in.
    pub name: &'a str,
    /// Whole inputs, good and bad.
    pub corpus: Vec<Vec<u8>>,
    /// Pieces that mean something.
    pub dictionary: &'a [&'a str],
    /// Bytes that may be taken for an input of this length, on top of the input itself.
    pub memory: fn(usize) -> usize,
    /// Reads the input; panics where a promise is broken.
    pub read: fn(&[u8]),
    /// The allocator of the test binary.
    pub allocator: &'a PeakAlloc,
}

impl Subject<'_> {
    /// Reads one input and says what promise it breaks, and how much memory it took.
    fn broken_by(&self, input: &[u8]) -> (Option<String>, usize) {
        self.allocator.reset_peak_usage();
        let before = self.allocator.current_usage();
        let ended = catch_unwind(AssertUnwindSafe(|| (self.read)(input)));
        let taken = self.allocator.peak_usage().saturating_sub(before);
        let allowed = (self.memory)(input.len());
        let broken = match ended {
            Err(panic) => Some(format!("it panics: {}", message(panic.as_ref()))),
            Ok(()) if taken > allowed => Some(format!("it takes {taken} bytes, and {allowed} are agreed")),
            Ok(()) => None,
        };
        (broken, taken)
    }

    /// Reads inputs that were written by hand or found by the fuzzer.
    pub fn hold(&self, what: &str, input: &[u8]) {
        let _alone = alone();
        let guard = Guard::new(self.name);
        guard.begin(input);
        let begun = Instant::now();
        let (broken, taken) = self.broken_by(input);
        if let Some(broken) = broken {
            let start = String::from_utf8_lossy(&input[..input.len().min(200)]).into_owned();
            panic!("{what}: {broken}\n{start}");
        }
        guard.end();
        if std::env::var_os("MAQUETTE_FUZZ_VERBOSE").is_some() {
            let taken = taken as f64 / 1e6;
            println!("{what}: {} bytes, {taken:.1} MB, {:.0?}", input.len(), begun.elapsed());
        }
    }

    /// Reads every file of a folder.
    pub fn hold_cases(&self, folder: &Path) {
        // Nothing was found as long as there is no folder.
        let Ok(entries) = std::fs::read_dir(folder) else { return };
        let mut paths: Vec<_> = entries.map(|entry| entry.unwrap().path()).collect();
        paths.sort();
        for path in paths.iter().filter(|path| path.extension().is_none_or(|e| e != "md")) {
            self.hold(&path.display().to_string(), &std::fs::read(path).unwrap());
        }
    }

    /// Damages the corpus and reads it.
    pub fn fuzz(&self) {
        let _alone = alone();
        let guard = Guard::new(self.name);
        let seconds: Option<u64> = std::env::var("MAQUETTE_FUZZ_SECONDS").ok().map(|s| s.parse().unwrap());
        let seed = seconds.map_or(1, |_| {
            u64::try_from(SystemTime::UNIX_EPOCH.elapsed().unwrap().as_nanos() & u128::from(u64::MAX)).unwrap()
        });
        let (mut dice, mut tried, begun) = (Dice(seed), 0, Instant::now());
        while seconds.map_or(tried < INPUTS, |seconds| begun.elapsed() < Duration::from_secs(seconds)) {
            tried += 1;
            let input = self.damaged(&mut dice);
            guard.begin(&input);
            if let (Some(broken), _) = self.broken_by(&input) {
                let path = kept(self.name, &input);
                panic!("{broken}\nthe input, number {tried} of seed {seed}, is kept in {}", path.display());
            }
            guard.end();
        }
        if seconds.is_some() {
            println!("{}: {tried} inputs, seed {seed}", self.name);
        }
    }

    fn damaged(&self, dice: &mut Dice) -> Vec<u8> {
        let pick = |dice: &mut Dice| self.corpus[dice.below(self.corpus.len())].clone();
        let mut input = pick(dice);
        // Mostly a few changes: what is damaged all over is refused at once.
        let most = if dice.below(4) == 0 { 30 } else { 5 };
        let changes = 1 + dice.below(most);
        for _ in 0..changes {
            if input.len() > 400_000 {
                break;
            }
            let length = input.len();
            match dice.below(14) {
                0 => {
                    let at = dice.below(length + 1);
                    input.insert(at, u8::try_from(dice.below(256)).unwrap());
                }
                1 if length > 0 => input[dice.below(length)] ^= 1 << dice.below(8),
                2 => drop(input.drain(dice.range(length, 40))),
                3 => drop(input.drain(dice.range(length, length))),
                4 => {
                    // Again and again, which is how few bytes ask for much.
                    let piece = input[dice.range(length, 200)].to_vec();
                    let times = 1 << dice.below(12);
                    let at = dice.below(length + 1);
                    input.splice(at..at, piece.repeat(times));
                }
                5 => {
                    let other = pick(dice);
                    let piece = other[dice.range(other.len(), 400)].to_vec();
                    let range = dice.range(length, 40);
                    input.splice(range, piece);
                }
                6 => {
                    let piece = input[dice.range(length, 100)].to_vec();
                    let range = dice.range(length, 100);
                    input.splice(range, piece);
                }
                7 => {
                    let (open, close) =
                        [("(", ")"), ("[", "]"), ("{", "}"), ("/*", "*/"), ("Some(", ")"), ("<g>", "</g>")]
                            [dice.below(6)];
                    let (range, times) = (dice.range(length, 60), 1 << dice.below(14));
                    let inner = input[range.clone()].to_vec();
                    let wrapped = [open.repeat(times).as_bytes(), &inner, close.repeat(times).as_bytes()].concat();
                    input.splice(range, wrapped);
                }
                8..=9 => self.change_a_number(&mut input, dice),
                _ => {
                    let word = self.dictionary[dice.below(self.dictionary.len())].as_bytes().to_vec();
                    let range = if dice.below(2) == 0 { dice.range(length, 0) } else { dice.range(length, 12) };
                    input.splice(range, word);
                }
            }
        }
        input
    }

    fn change_a_number(&self, input: &mut Vec<u8>, dice: &mut Dice) {
        let from = dice.below(input.len() + 1);
        let Some(start) = input[from..].iter().position(u8::is_ascii_digit).map(|at| from + at) else { return };
        let length = input[start..].iter().take_while(|b| b.is_ascii_digit() || **b == b'.').count();
        let number = [
            "0",
            "-1",
            "1",
            "2",
            "255",
            "65536",
            "4294967295",
            "4294967296",
            "1000000000000",
            "18446744073709551616",
            "9223372036854775807",
            "-9223372036854775808",
            "1e308",
            "1e-308",
            "1e999",
            "-0.0",
            "NaN",
            "inf",
            "0.1.2",
            "",
        ][dice.below(20)];
        input.splice(start..start + length, number.bytes());
    }
}

fn message(panic: &(dyn Any + Send)) -> String {
    let text = panic.downcast_ref::<&str>().map(|s| (*s).to_owned());
    text.or_else(|| panic.downcast_ref::<String>().cloned()).unwrap_or_default()
}

/// Keeps an input that broke a promise, outside of the source tree.
fn kept(name: &str, input: &[u8]) -> PathBuf {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR"));
    let path = folder.join(format!("fuzz-{name}-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    std::fs::write(&path, input).unwrap();
    path
}

/// The input that is tried, and since when.
type Current = Arc<Mutex<Option<(Instant, Vec<u8>)>>>;

/// Ends the process where an input takes forever, and keeps that input.
struct Guard {
    current: Current,
}

impl Guard {
    fn new(name: &str) -> Self {
        let current = Current::default();
        let (watched, name) = (Arc::downgrade(&current), name.to_owned());
        std::thread::spawn(move || {
            while let Some(current) = watched.upgrade() {
                let current = current.lock().unwrap_or_else(PoisonError::into_inner).clone();
                if let Some((begun, input)) = current.filter(|(begun, _)| begun.elapsed() > HANG) {
                    let path = kept(&name, &input);
                    eprintln!("it hangs for {:?}; the input is kept in {}", begun.elapsed(), path.display());
                    std::process::abort();
                }
                std::thread::sleep(Duration::from_millis(500));
            }
        });
        Self { current }
    }

    fn begin(&self, input: &[u8]) {
        *self.current.lock().unwrap_or_else(PoisonError::into_inner) = Some((Instant::now(), input.to_vec()));
    }

    fn end(&self) {
        *self.current.lock().unwrap_or_else(PoisonError::into_inner) = None;
    }
}

//! `--openjd FILE`: the wedge as an Open Job Description job template (jobtemplate-2023-09), for the queues of render
//! farms. Each variant is a task that runs `maquette run` with its values, without a shell in between.
//!
//! Source: the template schemas of <https://github.com/OpenJobDescription/openjd-specifications>, version 2023-09.

use std::collections::BTreeSet;
use std::path::{Component, Path, PathBuf};

use maquette_graph::{Literal, LiteralKind};
use serde_json::{Value as Json, json};

use super::Arguments;
use super::pattern::{Part, Pattern, file_name, value_text};
use super::plan::Plan;
use super::values::Value;
use crate::commands::overrides::Place;

/// Most values of a parameter, by the specification.
const MOST_VALUES: usize = 1024;
/// Most parameters of a step, by the specification.
const MOST_PARAMETERS: usize = 16;
/// Longest name of a parameter, by the specification, less what is added to tell names apart.
const LONGEST_NAME: usize = 48;

/// A parameter of the tasks.
struct Parameter {
    name: String,
    kind: &'static str,
    range: Vec<Json>,
}

/// The template as a file; what can't be said in one is an error.
pub(super) fn template(arguments: &Arguments, plan: &Plan, path: &Path) -> Result<Vec<u8>, String> {
    let extension = path.extension().map(|extension| extension.to_string_lossy().to_lowercase());
    if !matches!(extension.as_deref(), Some("json" | "yaml" | "yml")) {
        return Err(format!("error: --openjd {}: end it in .json or .yaml", path.display()));
    }
    let template = build(arguments, plan, path).map_err(|error| format!("error: --openjd: {error}"))?;
    // Each JSON text is a YAML text as well.
    Ok(format!("{template:#}\n").into_bytes())
}

fn build(arguments: &Arguments, plan: &Plan, path: &Path) -> Result<Json, String> {
    if plan.patterns.is_empty() {
        return Err("give -o as well: the tasks would write nothing".to_owned());
    }
    let tasks = Tasks::new(plan)?;
    let (folder, files) = output(plan, &tasks)?;
    let mut args = vec!["run".to_owned(), "{{Param.Graph}}".to_owned()];
    for set in &arguments.evaluation.set {
        args.extend(["--set".to_owned(), plain(&absolute_file(plan, set))?]);
    }
    for (axis, name) in plan.variants.axes.iter().zip(&tasks.values) {
        args.extend(["--set".to_owned(), format!("{}={{{{Task.Param.{name}}}}}", plain(&axis.address)?)]);
    }
    for output in &arguments.evaluation.outputs {
        args.extend(["--output".to_owned(), plain(output)?]);
    }
    for limit in &arguments.fail_if {
        args.extend(["--fail-if".to_owned(), plain(limit)?]);
    }
    if arguments.evaluation.threads > 0 {
        args.extend(["--threads".to_owned(), arguments.evaluation.threads.to_string()]);
    }
    if arguments.evaluation.keep_going {
        args.push("--keep-going".to_owned());
    }
    args.push("--create-folders".to_owned());
    args.extend(files.into_iter().flat_map(|file| ["-o".to_owned(), file]));
    let stem = plan.file.path.file_stem().map_or_else(String::new, |stem| stem.to_string_lossy().into_owned());
    let name = plain(&format!("maquette wedge of {stem}"))?.chars().take(120).collect::<String>();
    let mut space = json!({ "taskParameterDefinitions": tasks.definitions() });
    if tasks.parameters.len() > 1 {
        space["combination"] = Json::from(tasks.combination.clone());
    }
    Ok(json!({
        "specificationVersion": "jobtemplate-2023-09",
        "name": name,
        "parameterDefinitions": [
            path_parameter("Graph", "FILE", "IN", "The graph, a .ron file; the files it reads lie beside it.", &plan.file.path, path),
            path_parameter("OutputFolder", "DIRECTORY", "OUT", "Where the results go.", &folder, path),
            json!({ "name": "Maquette", "type": "STRING", "default": "maquette", "description": "The program." }),
        ],
        "steps": [{
            "name": "wedge",
            "parameterSpace": space,
            "script": { "actions": { "onRun": { "command": "{{Param.Maquette}}", "args": args } } },
        }],
    }))
}

/// A parameter of the job. The specification wants defaults that lie in the folder of the template; others are given
/// when the job is made.
fn path_parameter(name: &str, object: &str, flow: &str, description: &str, place: &Path, template: &Path) -> Json {
    let mut parameter =
        json!({ "name": name, "type": "PATH", "objectType": object, "dataFlow": flow, "description": description });
    let folder = template.parent().unwrap_or(Path::new(""));
    if let Some((folder, place)) = absolute(folder).zip(absolute(place))
        && let Ok(inside) = place.strip_prefix(&folder)
        && let Some(inside) = inside.to_str()
    {
        parameter["default"] = Json::from(if inside.is_empty() { "." } else { inside });
    }
    parameter
}

/// The path from the root, links followed as far as it is there.
fn absolute(path: &Path) -> Option<PathBuf> {
    let path = std::path::absolute(if path.as_os_str().is_empty() { Path::new(".") } else { path }).ok()?;
    let there = path.ancestors().find_map(|ancestor| Some((ancestor, ancestor.canonicalize().ok()?)));
    let Some((ancestor, real)) = there else { return Some(path) };
    let rest = path.strip_prefix(ancestor).ok()?;
    // What is not there yet must not lead up again.
    if rest.components().any(|component| component == Component::ParentDir) {
        return None;
    }
    Some(if rest.as_os_str().is_empty() { real } else { real.join(rest) })
}

/// A `--set` whose file is named from the root: tasks run in a folder of their own.
fn absolute_file(plan: &Plan, set: &str) -> String {
    let file = set.split_once('=').and_then(|(address, value)| {
        let place = Place::find(&plan.file.loaded.graph, address).ok()?;
        match place.read(value).ok()? {
            Literal::File(path) => Some(format!("{address}={path}")),
            _ => None,
        }
    });
    file.unwrap_or_else(|| set.to_owned())
}

/// A text that means itself in a template.
fn plain(text: &str) -> Result<String, String> {
    if text.contains("{{") || text.contains("}}") {
        return Err(format!("\"{text}\" has double curly brackets, which mean something else in a job template"));
    }
    if text.chars().any(char::is_control) {
        return Err(format!("\"{}\" has a character that a job template can't hold", text.escape_debug()));
    }
    Ok(text.to_owned())
}

/// The parameters of the tasks.
struct Tasks {
    parameters: Vec<Parameter>,
    /// Which of them combine, and which go in step.
    combination: String,
    /// The name of the parameter that holds the values of each axis.
    values: Vec<String>,
    /// The name of the parameter that stands in file names for each axis, where one does.
    names: Vec<Option<String>>,
    index: Option<String>,
}

impl Tasks {
    fn new(plan: &Plan) -> Result<Self, String> {
        let variants = &plan.variants;
        let parts = || plan.patterns.iter().flat_map(|pattern| &pattern.parts);
        let indexed = parts().any(|part| *part == Part::Index);
        // Without an order that the farm could count out by itself, each variant is written out.
        let full: usize = variants.groups.iter().map(|group| variants.axes[group[0]].values.len()).product();
        let regular = variants.groups.iter().all(|group| {
            let length = variants.axes[group[0]].values.len();
            group.iter().all(|axis| variants.axes[*axis].values.len() == length)
        });
        let flat = indexed || !regular || full != variants.len();
        let flat = flat || variants.groups.iter().any(|group| !in_step(plan, group));
        let mut taken = BTreeSet::new();
        let mut tasks =
            Self { parameters: vec![], combination: String::new(), values: vec![], names: vec![], index: None };
        let mut of_axis: Vec<Vec<String>> = Vec::new();
        for (place, axis) in variants.axes.iter().enumerate() {
            let values: Vec<&Value> = if flat {
                let value = |variant| &axis.values[variants.choice(variant).nth(place).unwrap_or_default()];
                (0..variants.len()).map(value).collect()
            } else {
                axis.values.iter().collect()
            };
            let whole = axis.place.wanted == LiteralKind::Integer;
            let range = values.iter().map(|value| task_value(value)).collect::<Result<_, _>>()?;
            let name = identifier(&axis.address, &mut taken);
            let mut mine = vec![name.clone()];
            tasks.parameters.push(Parameter { name: name.clone(), kind: if whole { "INT" } else { "STRING" }, range });
            tasks.values.push(name.clone());
            let used = parts().any(|part| *part == Part::Axis(place));
            let same = axis.values.iter().all(|value| file_name(value_text(value)) == value.text);
            if used && !same {
                let name = identifier(&format!("{name}_name"), &mut taken);
                let range = values.iter().map(|value| Json::from(file_name(value_text(value)))).collect();
                tasks.parameters.push(Parameter { name: name.clone(), kind: "STRING", range });
                mine.push(name.clone());
                tasks.names.push(Some(name));
            } else {
                tasks.names.push(used.then_some(name));
            }
            of_axis.push(mine);
        }
        let mut groups: Vec<Vec<String>> = if flat {
            vec![of_axis.concat()]
        } else {
            variants.groups.iter().map(|group| group.iter().flat_map(|axis| of_axis[*axis].clone()).collect()).collect()
        };
        if indexed {
            let digits = variants.len().to_string().len();
            let name = identifier("index", &mut taken);
            let range = (1..=variants.len()).map(|index| Json::from(format!("{index:0digits$}"))).collect();
            tasks.parameters.push(Parameter { name: name.clone(), kind: "STRING", range });
            groups.iter_mut().for_each(|group| group.push(name.clone()));
            tasks.index = Some(name);
        }
        let group =
            |group: &Vec<String>| if group.len() > 1 { format!("({})", group.join(", ")) } else { group.concat() };
        tasks.combination = groups.iter().map(group).collect::<Vec<_>>().join(" * ");
        tasks.check(flat)?;
        Ok(tasks)
    }

    fn check(&self, flat: bool) -> Result<(), String> {
        if self.parameters.len() > MOST_PARAMETERS {
            let count = self.parameters.len();
            return Err(format!("{count} parameters are needed, and a template holds {MOST_PARAMETERS}: vary less"));
        }
        match self.parameters.iter().find(|parameter| parameter.range.len() > MOST_VALUES) {
            None => Ok(()),
            Some(parameter) => {
                let count = parameter.range.len();
                let remedy =
                    if flat { "; name the files by their values in place of {index}, or vary less" } else { "" };
                Err(format!("{} takes {count} values, and a template holds {MOST_VALUES}{remedy}", parameter.name))
            }
        }
    }

    fn definitions(&self) -> Vec<Json> {
        let definition = |p: &Parameter| json!({ "name": p.name, "type": p.kind, "range": p.range });
        self.parameters.iter().map(definition).collect()
    }
}

/// Whether the axes of a group take their values in step, each value once.
fn in_step(plan: &Plan, group: &[usize]) -> bool {
    (0..plan.variants.len()).all(|variant| {
        let choice: Vec<usize> = plan.variants.choice(variant).collect();
        group.iter().all(|axis| choice[*axis] == choice[group[0]])
    })
}

/// A value as `--set` takes it.
fn task_value(value: &Value) -> Result<Json, String> {
    match &value.literal {
        Literal::Integer(whole) => Ok(Json::from(*whole)),
        Literal::File(path) => plain(path).map(Json::from),
        _ => plain(&value.text).map(Json::from),
    }
}

/// An address as the name of a parameter: letters, digits and `_`, different from all others.
fn identifier(address: &str, taken: &mut BTreeSet<String>) -> String {
    let letter = |c: char| if c.is_ascii_alphanumeric() { c } else { '_' };
    let mut name: String = address.chars().take(LONGEST_NAME).map(letter).collect();
    if !name.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_') {
        name.insert(0, '_');
    }
    let mut unique = name.clone();
    let mut number = 2;
    while !taken.insert(unique.clone()) {
        unique = format!("{name}_{number}");
        number += 1;
    }
    unique
}

/// The folder that all files lie in, and their names from there on.
fn output(plan: &Plan, tasks: &Tasks) -> Result<(PathBuf, Vec<String>), String> {
    let folders: Option<Vec<PathBuf>> = plan.patterns.iter().map(|pattern| absolute(&pattern.folder())).collect();
    let folders = folders.ok_or("a folder of -o leads up from one that is not there; name it directly")?;
    let mut common = folders[0].clone();
    while !folders.iter().all(|folder| folder.starts_with(&common)) {
        common.pop();
    }
    let file = |(pattern, folder): (&Pattern, &PathBuf)| -> Result<String, String> {
        let inside = folder.strip_prefix(&common).map_err(|error| error.to_string())?;
        let mut name = "{{Param.OutputFolder}}".to_owned();
        for component in inside.components() {
            name += &format!("/{}", plain(&component.as_os_str().to_string_lossy())?);
        }
        name.push('/');
        let skipped = pattern.folder().as_os_str().len();
        for (place, part) in pattern.parts.iter().enumerate() {
            match part {
                Part::Text(text) if text.contains(['{', '}']) => {
                    return Err(format!("-o {}: a job template can't have curly brackets in names", pattern.text));
                }
                Part::Text(text) => name += &plain(if place == 0 { &text[skipped..] } else { text })?,
                Part::Axis(axis) => {
                    name += &format!("{{{{Task.Param.{}}}}}", tasks.names[*axis].as_deref().unwrap_or_default());
                }
                Part::Index => name += &format!("{{{{Task.Param.{}}}}}", tasks.index.as_deref().unwrap_or_default()),
            }
        }
        Ok(name)
    };
    let files = plan.patterns.iter().zip(&folders).map(file).collect::<Result<_, _>>()?;
    Ok((common, files))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn addresses_become_names_that_differ() {
        let mut taken = BTreeSet::new();
        let names = ["legs.height", "legs-height", "3d", "h\u{e9}m.x", ""].map(|a| identifier(a, &mut taken));
        assert_eq!(names, ["legs_height", "legs_height_2", "_3d", "h_m_x", "_"]);
        assert!(identifier(&"x".repeat(500), &mut taken).len() <= 64);
    }

    #[test]
    fn texts_that_mean_something_else_are_refused() {
        assert!(plain("{{Param.Graph}}").unwrap_err().contains("double curly brackets"));
        assert!(plain("a\nb").unwrap_err().contains("a\\nb"));
        assert_eq!(plain("a 'b' \"$c\" {d}").unwrap(), "a 'b' \"$c\" {d}");
    }
}

//! Meaning of a key: the documentation of the field that it becomes, found where the source asks for it. Keys that become none have
//! their words in [`KEY_WORDS`].

use std::collections::BTreeMap;
use std::path::Path;

use crate::error::ConfigError;
use crate::file::{self, ConfigReader};
use crate::key_words::KEY_WORDS;
use crate::questions::Question;

/// Documentation of the fields of a source file, by type and field.
type Fields = BTreeMap<(String, String), String>;

/// Source files that read configuration, by their names.
pub(crate) struct Sources(BTreeMap<String, (Vec<String>, Fields)>);

impl Sources {
    /// Those of a folder.
    pub(crate) fn read(folder: &Path) -> Result<Self, ConfigError> {
        let names = file::names(folder, "rs").unwrap_or_default();
        if names.is_empty() {
            let text = "holds no source; the reference is made in a clone of the repository";
            return Err(ConfigError::of_file(folder, text));
        }
        let mut all = BTreeMap::new();
        for name in names {
            let path = folder.join(&name).with_extension("rs");
            let text = file::text(&path, &mut ConfigReader::default())?;
            let lines: Vec<String> = text.lines().map(str::to_owned).collect();
            let fields = documented(&lines);
            all.insert(name, (lines, fields));
        }
        Ok(Self(all))
    }

    /// Meaning of the key `path` that a question asks for, in one sentence; empty if nobody says it.
    pub(crate) fn meaning(&self, path: &str, question: &Question) -> String {
        let fits = |end: &str| match end.strip_prefix('/') {
            Some(whole) => path == whole,
            None => path.strip_suffix(end).is_some_and(|rest| rest.is_empty() || rest.ends_with('.')),
        };
        let said = KEY_WORDS.iter().find(|(end, _)| fits(end));
        let key = question.path.rsplit('.').next().unwrap_or_default().split('[').next().unwrap_or_default();
        said.map(|(_, words)| (*words).to_owned())
            .or_else(|| self.of_source(question, key))
            .unwrap_or_default()
    }

    fn of_source(&self, question: &Question, key: &str) -> Option<String> {
        let name = Path::new(question.source).file_stem()?.to_str()?;
        let (lines, fields) = self.0.get(name)?;
        // The line that asks, or the next one that names the key: a closure may ask for several.
        let quoted = format!("\"{key}\"");
        let asks = question.line - 1;
        let near = (asks..lines.len().min(asks + 4)).find(|i| lines[*i].contains(&quoted));
        let near = near.or_else(|| lines.iter().position(|line| line.contains(&quoted)));
        let line = near.unwrap_or(asks);
        let ident = (line.saturating_sub(5)..=line).rev().find_map(|i| assigned(&lines[i]));
        let owner = lines[..line].iter().rev().find_map(|line| line.strip_prefix("impl "));
        let owner = owner?.split([' ', '<', '{']).next()?.to_owned();
        // Of that type alone: a field of the same name elsewhere means something else.
        let of = |field: &str| fields.get(&(owner.clone(), field.to_owned()));
        of(key).or_else(|| of(ident.as_deref()?)).cloned()
    }
}

/// Name of the field or variable that a line gives a value.
fn assigned(line: &str) -> Option<String> {
    let line = line.trim_start();
    let end = line.find(|c: char| !(c.is_ascii_alphanumeric() || c == '_'))?;
    let (name, rest) = line.split_at(end);
    match name {
        "let" => {
            let rest = rest.trim_start();
            let end = rest.find(|c: char| !(c.is_ascii_alphanumeric() || c == '_'))?;
            (end > 0).then(|| rest[..end].to_owned())
        }
        _ => (!name.is_empty() && rest.starts_with(": ")).then(|| name.to_owned()),
    }
}

/// Documented fields of the types in a source file.
fn documented(lines: &[String]) -> Fields {
    let (mut fields, mut owner, mut doc) = (Fields::new(), String::new(), String::new());
    for line in lines {
        let code = line.trim_start();
        let named = |word: &str| line.split_once(word).map(|(_, rest)| rest);
        if let Some(text) = code.strip_prefix("/// ") {
            doc += if doc.is_empty() { "" } else { " " };
            doc += text;
            continue;
        }
        if let Some(rest) = named("struct ").filter(|_| !line.starts_with(' ')) {
            owner = rest.split([' ', '<', '{', '(']).next().unwrap_or_default().to_owned();
        }
        let field = code.trim_start_matches("pub(crate) ").trim_start_matches("pub ");
        if let Some(name) = assigned(field).filter(|_| !doc.is_empty()) {
            fields.insert((owner.clone(), name), plain(&doc));
        }
        doc.clear();
    }
    fields
}

/// Text of a documentation comment without its unit and its links.
fn plain(doc: &str) -> String {
    let doc = match doc.strip_prefix("\\[").and_then(|rest| rest.split_once("\\]")) {
        Some((_, rest)) => rest.trim_start(),
        None => doc,
    };
    doc.replace("[`", "`").replace("`]", "`").replace('\\', "")
}

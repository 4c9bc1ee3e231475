//! The book in `docs`: every page is in its contents, and every link, anchor and picture of every page is there.

use super::{files, text};
use harness::root;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Component, Path, PathBuf};

/// Pages and pictures of the book.
fn book(ending: &str) -> BTreeSet<PathBuf> {
    files(&[ending]).into_iter().filter(|path| path.starts_with("docs")).collect()
}

/// Lines of a page without blocks of code and quotations.
fn prose(page: &str) -> String {
    let lines: String = page.split("```").step_by(2).collect();
    lines.split('`').enumerate().map(|(i, part)| if i % 2 == 0 { part } else { "code" }).collect()
}

/// Targets of links and pictures in running text.
fn targets(page: &str) -> Vec<String> {
    let prose = prose(page);
    prose.split("](").skip(1).filter_map(|rest| Some(rest.split_once(')')?.0.to_owned())).collect()
}

/// Anchors of a page's headings, as GitHub and mdBook make them.
fn anchors(page: &str) -> BTreeSet<String> {
    let (mut anchors, mut seen) = (BTreeSet::new(), BTreeMap::new());
    let lines: String = page.split("\n```").step_by(2).collect::<Vec<_>>().join("\n");
    for line in lines.lines().filter(|line| line.starts_with('#')) {
        let heading = line.trim_start_matches('#').trim();
        // Of a link its text.
        let heading: String = heading
            .split("](")
            .enumerate()
            .map(|(i, p)| if i == 0 { p } else { p.split_once(')').map_or("", |x| x.1) })
            .collect();
        let mut anchor = String::new();
        for c in heading.chars().flat_map(char::to_lowercase) {
            match c {
                ' ' => anchor.push('-'),
                c if c.is_alphanumeric() || c == '-' || c == '_' => anchor.push(c),
                _ => {}
            }
        }
        let count: &mut usize = seen.entry(anchor.clone()).or_default();
        if *count > 0 {
            anchor = format!("{anchor}-{count}");
        }
        *count += 1;
        anchors.insert(anchor);
    }
    anchors
}

/// A path without `..`.
fn straight(path: &Path) -> PathBuf {
    let mut out = PathBuf::new();
    for part in path.components() {
        match part {
            Component::ParentDir => _ = out.pop(),
            part => out.push(part),
        }
    }
    out
}

#[test]
fn every_page_of_the_book_is_in_its_contents_once() {
    let listed = targets(&text("docs/SUMMARY.md"));
    let set: BTreeSet<PathBuf> = listed.iter().map(|target| Path::new("docs").join(target)).collect();
    assert_eq!(listed.len(), set.len(), "a page is listed twice");
    let mut pages = book(".md");
    assert!(pages.remove(Path::new("docs/SUMMARY.md")));
    let missing: Vec<_> = pages.difference(&set).collect();
    let nowhere: Vec<_> = set.difference(&pages).collect();
    assert!(
        missing.is_empty() && nowhere.is_empty(),
        "not in docs/SUMMARY.md: {missing:?}; not in docs: {nowhere:?}"
    );
    assert!(pages.len() > 30, "{}", pages.len());
}

#[test]
fn every_link_of_the_book_leads_somewhere() {
    let (mut broken, mut checked) = (Vec::new(), 0);
    let mut pages = book(".md");
    pages.insert("README.md".into());
    for page in &pages {
        let whole = text(page);
        for target in targets(&whole).into_iter().filter(|t| !t.contains("://") && !t.starts_with("mailto:"))
        {
            let (path, anchor) =
                target.split_once('#').map_or((target.as_str(), None), |(p, a)| (p, Some(a)));
            let to = match path {
                "" => page.clone(),
                path => straight(&page.parent().unwrap().join(path)),
            };
            let has = |anchor: &str| anchors(&text(&to)).contains(anchor);
            let is_there = root().join(&to).exists();
            if !is_there || anchor.is_some_and(|anchor| !has(anchor)) {
                broken.push(format!("{}: {target}", page.display()));
            }
            checked += 1;
        }
    }
    assert!(broken.is_empty(), "{} of {checked} links lead nowhere:\n{}", broken.len(), broken.join("\n"));
    assert!(checked > 200, "{checked}");
}

/// A picture that no page shows makes the executable larger for nobody.
#[test]
fn every_picture_of_the_book_is_shown() {
    let mut shown = BTreeSet::new();
    let mut pages = book(".md");
    pages.insert("README.md".into());
    for page in &pages {
        shown
            .extend(targets(&text(page)).iter().map(|target| straight(&page.parent().unwrap().join(target))));
    }
    let hidden: Vec<_> = book(".png").difference(&shown).cloned().collect();
    assert!(hidden.is_empty(), "nobody shows {hidden:?}");
}

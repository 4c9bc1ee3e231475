//! Contents of the book: the list of `docs/SUMMARY.md`, in the form that mdBook reads.

use std::sync::LazyLock;

use super::text;

/// Page that is read first.
pub(super) const FIRST: &str = "README.md";

/// A page of the book.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct BookPage {
    /// Name in the contents.
    pub title: &'static str,
    /// Path in `docs`.
    pub path: &'static str,
    /// Part of the book that begins with it; empty: the one before goes on.
    pub part: &'static str,
    /// It belongs to the page before it that is less deep.
    pub depth: usize,
}

static PAGES: LazyLock<Vec<BookPage>> = LazyLock::new(|| read(text("SUMMARY.md")));

/// All pages in the order of reading.
pub fn pages() -> &'static [BookPage] {
    &PAGES
}

/// Place of the page of that path.
pub(super) fn number(path: &str) -> Option<usize> {
    PAGES.iter().position(|page| page.path == path)
}

/// Lines `- [title](path)`, two blanks for each level; `# Part` begins a part.
fn read(summary: &'static str) -> Vec<BookPage> {
    let (mut pages, mut part) = (Vec::new(), "");
    for line in summary.lines() {
        if let Some(name) = line.strip_prefix("# ") {
            // The first heading is that of the list itself.
            part = if name == "Summary" { "" } else { name };
        }
        let link = line.trim_start().trim_start_matches("- ").strip_prefix('[');
        if let Some((title, path)) = link.and_then(|rest| rest.split_once("](")) {
            let depth = (line.len() - line.trim_start().len()) / 2;
            let path = path.trim_end_matches(')');
            pages.push(BookPage { title, path, part: std::mem::take(&mut part), depth });
        }
    }
    pages
}

//! The book under `/book/`: `docs/` as it is inside the executable, so that it can be read beside a robot without a network. The same
//! files are the source of `mdbook build docs`.

mod contents;
mod render;

use include_dir::{Dir, include_dir};

pub use contents::{BookPage, pages};

/// Pages and pictures, by their paths in `docs`.
static DOCS: Dir<'static> = include_dir!("$OUT_DIR/book");

/// Path at which the book is served.
const ROOT: &str = "/book/";

/// Answer to a request for something of the book.
#[derive(Debug, PartialEq)]
pub enum BookAnswer {
    /// A page, HTML.
    Page(String),
    /// Another file with its type.
    File(&'static str, &'static [u8]),
    /// The book is elsewhere.
    Moved(&'static str),
}

/// Whatever is at `path` with the query `query`; none: nothing of the book.
pub fn answer(path: &str, query: Option<&str>) -> Option<BookAnswer> {
    if path == ROOT.trim_end_matches('/') {
        return Some(BookAnswer::Moved(ROOT));
    }
    let name = path.strip_prefix(ROOT)?;
    match name {
        "book.css" => return Some(BookAnswer::File("text/css; charset=utf-8", include_bytes!("book.css"))),
        "headings" => return Some(BookAnswer::Page(render::headings(&words(query)))),
        _ => {}
    }
    if let Some(number) = contents::number(if name.is_empty() { contents::FIRST } else { name }) {
        return Some(BookAnswer::Page(render::page(number)));
    }
    // Only names of files that are inside: no path is looked up on disk.
    let picture = name.ends_with(".png").then(|| DOCS.get_file(name))??;
    Some(BookAnswer::File("image/png", picture.contents()))
}

/// Text of a page of the book.
fn text(path: &str) -> &'static str {
    DOCS.get_file(path).and_then(|file| file.contents_utf8()).unwrap_or_default()
}

/// Words after `q=`, in lower case.
fn words(query: Option<&str>) -> Vec<String> {
    let asked = query.unwrap_or_default().split('&').find_map(|part| part.strip_prefix("q="));
    let text = asked.unwrap_or_default().replace(['+', '_'], " ").replace("%20", " ");
    text.split_whitespace().map(str::to_lowercase).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_is_in_the_book_is_answered() {
        for path in ["/book/../Cargo.toml", "/book/../../etc/passwd", "/book//etc/passwd", "/book/SUMMARY.md"]
        {
            assert_eq!(answer(path, None), None, "{path}");
        }
        for path in ["/book/pictures/make", "/book/gallery/accuracy.json", "/book/book.toml", "/robot.urdf"] {
            assert_eq!(answer(path, None), None, "{path}");
        }
        assert_eq!(answer("/book", None), Some(BookAnswer::Moved("/book/")));
        let picture = answer("/book/pictures/zmp.png", None);
        assert!(
            matches!(picture, Some(BookAnswer::File("image/png", bytes)) if bytes.starts_with(b"\x89PNG"))
        );
    }

    /// Headings that hold every word that was asked for, and no other.
    #[test]
    fn headings_are_found_by_their_words() {
        let Some(BookAnswer::Page(all)) = answer("/book/headings", None) else { panic!() };
        let Some(BookAnswer::Page(some)) = answer("/book/headings", Some("q=first+PUSH")) else { panic!() };
        assert!(all.matches("<li>").count() > 200 && all.contains("first_push.md"));
        let main = some.split("<main>").nth(1).unwrap();
        assert!(
            main.contains("tutorial/first_push.md#") && !main.contains("tutorial/first_walk.md#"),
            "{main}"
        );
        let Some(BookAnswer::Page(none)) = answer("/book/headings", Some("q=<b>xyzzy")) else { panic!() };
        assert!(!none.contains("<b>") && none.contains("No heading"));
    }
}

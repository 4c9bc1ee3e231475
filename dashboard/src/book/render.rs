//! Pages of the book as HTML: text, contents at the side, the pages before and after. No script, and no markup but Markdown's.

use std::collections::BTreeMap;
use std::fmt::Write;

use pulldown_cmark::{CowStr, Event, Options, Parser, Tag, TagEnd, html};

use super::contents::{self, BookPage, pages};
use super::{DOCS, text};

/// Heading of a page.
struct Heading {
    /// Text without its markup.
    text: String,
    /// Name by which a link finds it.
    anchor: String,
}

/// Page `number` of the contents.
pub(super) fn page(number: usize) -> String {
    let page = &pages()[number];
    let (body, headings) = body(page.path);
    let title = headings.first().map_or(page.title, |heading| &heading.text);
    let near = |step: Option<usize>, word: &str, class: &str| {
        let other = step.and_then(|i| pages().get(i));
        other.map_or(String::new(), |other| {
            let (path, title) = (other.path, escaped(other.title));
            format!("<a class=\"{class}\" href=\"/book/{path}\"><span>{word}</span> {title}</a>")
        })
    };
    let before = near(number.checked_sub(1), "Previous", "before");
    let after = near(Some(number + 1), "Next", "after");
    let main =
        format!("<article>{body}</article><nav class=\"near\" aria-label=\"Pages\">{before}{after}</nav>");
    whole(title, Some(number), &main)
}

/// List of all headings that hold each of `words`.
pub(super) fn headings(words: &[String]) -> String {
    let mut main = String::from(
        "<article><h1>All headings</h1><p>Search them with your browser, or by address: <code>/book/headings?q=push</code>.</p>",
    );
    let mut found = 0;
    for page in pages() {
        let (_, all) = body(page.path);
        let fits = |heading: &&Heading| {
            let text = heading.text.to_lowercase();
            words.iter().all(|word| text.contains(word))
        };
        let items: Vec<String> = all.iter().filter(fits).map(|heading| item(page, heading)).collect();
        if !items.is_empty() {
            found += items.len();
            let _ = write!(main, "<h2>{}</h2><ul>{}</ul>", escaped(page.title), items.concat());
        }
    }
    if found == 0 {
        main += "<p>No heading holds these words.</p>";
    }
    whole("All headings", None, &(main + "</article>"))
}

fn item(page: &BookPage, heading: &Heading) -> String {
    format!("<li><a href=\"/book/{}#{}\">{}</a></li>", page.path, heading.anchor, escaped(&heading.text))
}

/// A document of the book with its side.
fn whole(title: &str, here: Option<usize>, main: &str) -> String {
    let mut side = String::new();
    for (i, page) in pages().iter().enumerate() {
        if !page.part.is_empty() {
            let _ = write!(side, "<h2>{}</h2>", escaped(page.part));
        }
        let current = if here == Some(i) { " aria-current=\"page\"" } else { "" };
        let (depth, path, title) = (page.depth, page.path, escaped(page.title));
        let _ = write!(side, "<a class=\"depth-{depth}\" href=\"/book/{path}\"{current}>{title}</a>");
    }
    let title = escaped(title);
    format!(
        "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <meta name=\"color-scheme\" content=\"dark light\">\n<title>{title} · Gangwerk</title>\n\
         <link rel=\"icon\" href=\"data:,\">\n<link rel=\"stylesheet\" href=\"/app.css\">\n\
         <link rel=\"stylesheet\" href=\"/book/book.css\">\n</head>\n<body class=\"book\">\n\
         <header class=\"bar\"><a href=\"/book/\">Gangwerk</a><span class=\"spring\"></span>\
         <a href=\"/book/headings\">All headings</a></header>\n\
         <div class=\"leaf\"><details open><summary>Contents</summary><nav aria-label=\"Contents\">{side}</nav></details>\n\
         <main>{main}</main></div>\n</body>\n</html>\n"
    )
}

/// Text of a page as HTML, and its headings.
fn body(path: &str) -> (String, Vec<Heading>) {
    let options = Options::ENABLE_TABLES | Options::ENABLE_STRIKETHROUGH;
    let mut events: Vec<Event<'static>> = Vec::new();
    let mut headings: Vec<Heading> = Vec::new();
    let mut taken = BTreeMap::new();
    // Where the heading that is open begins, and whether links that are open lead somewhere.
    let (mut heading, mut leads): (Option<usize>, Vec<bool>) = (None, Vec::new());
    for event in Parser::new_ext(text(path), options) {
        match event {
            // Remarks for who edits, and markup that nobody checks.
            Event::Html(_) | Event::InlineHtml(_) => {}
            Event::Start(Tag::Heading { .. }) => {
                heading = Some(events.len());
                events.push(event);
            }
            Event::End(TagEnd::Heading(_)) => {
                if let Some(begin) = heading.take() {
                    let found = name(&events[begin + 1..], &mut taken);
                    if let Event::Start(Tag::Heading { id, .. }) = &mut events[begin] {
                        *id = Some(CowStr::from(found.anchor.clone()));
                    }
                    headings.push(found);
                }
                events.push(event);
            }
            // What lies beside the book is named, not linked.
            Event::Start(Tag::Link { ref dest_url, .. }) => {
                leads.push(is_reachable(path, dest_url));
                let span =
                    Event::InlineHtml("<span class=\"elsewhere\" title=\"in the source tree\">".into());
                events.push(if leads.last() == Some(&true) { event } else { span });
            }
            Event::End(TagEnd::Link) => {
                let led = leads.pop() == Some(true);
                events.push(if led { event } else { Event::InlineHtml("</span>".into()) });
            }
            // Wide tables are scrolled in a frame of their own.
            Event::Start(Tag::Table(_)) => {
                events.push(Event::Html("<div class=\"wide\" tabindex=\"0\">".into()));
                events.push(event);
            }
            Event::End(TagEnd::Table) => {
                events.push(event);
                events.push(Event::Html("</div>".into()));
            }
            _ => events.push(event),
        }
    }
    let mut out = String::new();
    html::push_html(&mut out, events.into_iter());
    // Blocks that are scrolled can be scrolled by the keyboard.
    (out.replace("<pre>", "<pre tabindex=\"0\">"), headings)
}

/// Text and anchor of a heading; equal ones are numbered, as everywhere where Markdown is read.
fn name(events: &[Event<'_>], taken: &mut BTreeMap<String, usize>) -> Heading {
    let mut text = String::new();
    for event in events {
        if let Event::Text(part) | Event::Code(part) = event {
            text += part;
        }
    }
    let kept = |c: &char| c.is_alphanumeric() || " -_".contains(*c);
    let mut anchor: String = text.to_lowercase().chars().filter(kept).collect();
    anchor = anchor.replace(' ', "-");
    let count = taken.entry(anchor.clone()).or_insert(0);
    *count += 1;
    if *count > 1 {
        anchor += &format!("-{}", *count - 1);
    }
    Heading { text, anchor }
}

/// True if a link of the page `from` leads to another page, a place in one, a picture, or out into the web.
fn is_reachable(from: &str, to: &str) -> bool {
    if to.contains("://") || to.starts_with('#') || to.starts_with("mailto:") {
        return true;
    }
    let mut place: Vec<&str> = from.split('/').collect();
    place.pop();
    for part in to.split('#').next().unwrap_or_default().split('/') {
        match part {
            "." => {}
            ".." if place.pop().is_none() => return false,
            ".." => {}
            _ => place.push(part),
        }
    }
    let path = place.join("/");
    contents::number(&path).is_some() || path.ends_with(".png") && DOCS.get_file(&path).is_some()
}

/// Text of which nothing is markup.
fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

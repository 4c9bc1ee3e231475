//! The book that a dashboard serves, read without a robot and without a browser.

use crate::EXE;
use crate::page::Server;
use dashboard::book::pages;
use harness::Site;
use std::collections::{BTreeMap, BTreeSet};

/// Values of an attribute.
fn values<'a>(html: &'a str, attribute: &str) -> Vec<&'a str> {
    let begin = format!("{attribute}=\"");
    html.split(&begin).skip(1).filter_map(|rest| rest.split('"').next()).collect()
}

/// Path of what a page at `from` names as `to`.
fn absolute(from: &str, to: &str) -> String {
    if to.starts_with('/') {
        return to.to_owned();
    }
    let mut parts: Vec<&str> = from.split('/').collect();
    parts.pop();
    for part in to.split('/') {
        if part == ".." {
            parts.pop();
        } else {
            parts.push(part);
        }
    }
    parts.join("/")
}

#[test]
fn the_book_is_served_whole_and_its_links_lead_somewhere() {
    let site = Site::patient(EXE);
    let server = Server::start(&site);
    let to_host = format!("Host: {}", server.host);
    let get = |path: &str| server.ask(&[&format!("GET {path} HTTP/1.1"), &to_host, "Connection: close"]);
    // Every page of the contents, as a page: with the policy, without a script.
    let (mut bodies, mut named) = (BTreeMap::new(), BTreeSet::new());
    let mut paths: Vec<String> = pages().iter().map(|page| format!("/book/{}", page.path)).collect();
    paths.extend(["/book/".to_owned(), "/book/headings".to_owned()]);
    assert!(paths.len() > 30, "{}", paths.len());
    for path in paths {
        let answer = get(&path);
        let (head, body) = answer.split_once("\r\n\r\n").unwrap();
        assert!(
            head.starts_with("HTTP/1.1 200") && head.contains("text/html; charset=utf-8"),
            "{path}: {head}"
        );
        assert!(head.contains("default-src 'none'; script-src 'self';"), "{path}: {head}");
        assert!(
            !body.contains("<script") && !body.contains("javascript:") && !body.contains(&server.token),
            "{path}"
        );
        assert!(body.contains("<h1") && body.contains("aria-label=\"Contents\""), "{path}");
        bodies.insert(path, body.to_owned());
    }
    // Every link and picture within, with its place in the page.
    for (path, body) in &bodies {
        let links = values(body, "href").into_iter().chain(values(body, "src"));
        for link in links.filter(|link| !link.contains("://") && !link.starts_with("data:")) {
            let (to, anchor) = link.split_once('#').unwrap_or((link, ""));
            let to = if to.is_empty() { path.clone() } else { absolute(path, to) };
            if !anchor.is_empty() {
                let there = bodies.get(&to).unwrap_or_else(|| panic!("{path}: {link}: no page {to}"));
                assert!(there.contains(&format!(" id=\"{anchor}\"")), "{path}: {link}: no such place");
            }
            named.insert(to);
        }
    }
    let pictures = named.iter().filter(|to| to.ends_with(".png")).count();
    assert!(pictures > 20, "{pictures} pictures");
    for to in named.iter().filter(|to| !bodies.contains_key(*to)) {
        assert!(get(to).starts_with("HTTP/1.1 200"), "{to}");
    }
    // Ways out, and files that are none of its pages.
    for path in [
        "/book/../dashboard.url",
        "/book/../../etc/passwd",
        "/book/..%2f..%2fetc%2fpasswd",
        "/book//etc/passwd",
        "/book/SUMMARY.md",
        "/book/pictures/make",
        "/book/tutorial",
        "/book/nothing.md",
    ] {
        assert!(get(path).starts_with("HTTP/1.1 404"), "{path}");
    }
    let moved = get("/book");
    assert!(moved.starts_with("HTTP/1.1 308") && moved.contains("location: /book/"), "{moved}");
    // Headings by their words.
    let found = get("/book/headings?q=beyond");
    assert!(found.contains("/book/tutorial/first_push.md#beyond"), "{found}");
}

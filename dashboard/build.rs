//! The book that goes into the executable: pages and pictures of `docs`, without what they are made from.

use std::path::Path;
use std::{env, fs, io};

fn main() -> io::Result<()> {
    println!("cargo::rerun-if-changed=../docs");
    let out = env::var("OUT_DIR").map_err(io::Error::other)?;
    let book = Path::new(&out).join("book");
    let _ = fs::remove_dir_all(&book);
    copy(Path::new("../docs"), &book)
}

fn copy(from: &Path, to: &Path) -> io::Result<()> {
    fs::create_dir_all(to)?;
    for entry in fs::read_dir(from)?.flatten() {
        let (path, to) = (entry.path(), to.join(entry.file_name()));
        if path.is_dir() {
            copy(&path, &to)?;
        } else if path.extension().is_some_and(|ending| ending == "md" || ending == "png") {
            fs::copy(&path, &to)?;
        }
    }
    Ok(())
}

//! Identity of a client, as others are told of it: its own name and where it comes from, `gangwerk joystick (user 1000, pid 77)`.

/// Origin of a client on the socket, as the system knows it.
pub(crate) fn of_process(user: u32, process: Option<i32>) -> String {
    let pid = process.map_or("?".into(), |pid| pid.to_string());
    format!("user {user}, pid {pid}")
}

/// Identity of a client of this name and origin.
pub(crate) fn identity(name: &str, peer: &str) -> String {
    if name.is_empty() { peer.into() } else { format!("{name} ({peer})") }
}

/// True if the holder of the command lease is a connection of this process that goes by `name`, through the socket of the run
/// directory.
pub fn is_own(holder: &str, name: &str) -> bool {
    let peer = holder.strip_prefix(name).and_then(|rest| rest.strip_prefix(" ("));
    peer.is_some_and(|peer| peer.ends_with(&format!("pid {})", std::process::id())))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_client_knows_its_own_name_and_process() {
        let held = |name: &str, process: u32| identity(name, &of_process(1000, Some(process as i32)));
        let own = std::process::id();
        let page = held("dashboard page 1", own);
        assert!(is_own(&page, "dashboard page 1"), "{page}");
        // Another page of this server, another server, and a process whose number ends as this one's.
        assert!(!is_own(&held("dashboard page 12", own), "dashboard page 1"));
        assert!(!is_own(&held("dashboard page 1", own + 1), "dashboard page 1"));
        assert!(!is_own(&format!("dashboard page 1 (user 1000, pid 1{own})"), "dashboard page 1"));
        assert!(!is_own("", "dashboard page 1"));
    }
}

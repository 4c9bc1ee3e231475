//! Door for viewers: by Host, Origin, subprotocol, and token if there is one.
//!
//! Reading takes no token: viewers keep the addresses that were typed into them, and other programs of this machine may read the
//! broker, too. Strangers' pages are kept out by their Origin, and by Host if a name of theirs points here.

use std::sync::Arc;

use axum::Router;
use axum::extract::ws::WebSocketUpgrade;
use axum::extract::ws::rejection::WebSocketUpgradeRejection;
use axum::extract::{RawQuery, State};
use axum::http::{HeaderMap, HeaderName, StatusCode, header};
use axum::response::{IntoResponse, Response};
use axum::routing::get;

use crate::admission::Admission;
use crate::door::{WRITE_BUFFER, token};
use crate::foxglove::requests::LONGEST;
use crate::foxglove::socket::{self, Lobby, MOST_VIEWERS};

/// Subprotocols with the same messages: of Foxglove's open protocol, and of its software development kit.
const SUBPROTOCOLS: [&str; 2] = ["foxglove.websocket.v1", "foxglove.sdk.v1"];
/// Bytes that are put together to one write: a viewer of all channels is sent thousands of small messages per second.
const TOGETHER: usize = 32 << 10;
/// Origins of viewers that are not on this machine's own servers: Foxglove in a browser, Foxglove and Lichtblick on the desktop.
const ORIGINS: [&str; 2] = ["https://app.foxglove.dev", "file://"];

/// Door for viewers.
#[derive(Debug)]
pub struct ViewerDoor {
    /// Who comes in.
    pub admission: Admission,
    /// Common state of their sockets.
    pub lobby: Lobby,
}

/// Everything behind the door: one socket.
pub fn router(door: ViewerDoor) -> Router {
    Router::new().route("/", get(enter)).with_state(Arc::new(door))
}

/// Opens a socket for a viewer.
async fn enter(
    State(door): State<Arc<ViewerDoor>>,
    headers: HeaderMap,
    RawQuery(query): RawQuery,
    upgrade: Result<WebSocketUpgrade, WebSocketUpgradeRejection>,
) -> Response {
    // The sender is checked before anything else: strangers learn nothing.
    let refuse = |status: StatusCode, why: &str| (status, format!("{why}\n")).into_response();
    let may_command = match admit(&door.admission, &headers, token(query.as_deref())) {
        Ok(may_command) => may_command,
        Err(why) => return refuse(StatusCode::FORBIDDEN, why),
    };
    // What is asked for.
    let upgrade = match upgrade {
        Ok(upgrade) => upgrade.protocols(SUBPROTOCOLS),
        Err(rejection) => return rejection.into_response(),
    };
    if upgrade.selected_protocol().is_none() {
        let why = format!("a subprotocol is needed: one of {}", SUBPROTOCOLS.join(", "));
        return refuse(StatusCode::BAD_REQUEST, &why);
    }
    // A place is kept until the socket ends.
    let Ok(place) = door.lobby.places.clone().try_acquire_owned() else {
        let why = format!("{MOST_VIEWERS} viewers are connected; close one");
        return refuse(StatusCode::SERVICE_UNAVAILABLE, &why);
    };
    upgrade
        .max_message_size(LONGEST)
        .max_frame_size(LONGEST)
        .write_buffer_size(TOGETHER)
        .max_write_buffer_size(WRITE_BUFFER)
        .on_upgrade(move |socket| async move { socket::serve(socket, &door.lobby, may_command, place).await })
}

/// True if a viewer that may come in may also command.
fn admit(admission: &Admission, headers: &HeaderMap, token: Option<&str>) -> Result<bool, &'static str> {
    // What is there and no text is an Origin that nobody knows, and not one that is absent.
    let text = |name: HeaderName| headers.get(name).map(|value| value.to_str().unwrap_or("unreadable"));
    if !admission.is_host(text(header::HOST)) {
        return Err("this server has another name");
    }
    if text(header::ORIGIN).is_some_and(|origin| !is_viewer(origin)) {
        return Err("pages of this origin may not read the robot; docs/foxglove.md names those that may");
    }
    match token {
        None => Ok(false),
        Some(token) if admission.is_token(token) => Ok(true),
        Some(_) => Err("another token: the address that `gangwerk dashboard --foxglove` printed has it"),
    }
}

/// True of the origins of viewers: those that are known, and servers of this machine at any port.
fn is_viewer(origin: &str) -> bool {
    let host = origin.strip_prefix("http://").or_else(|| origin.strip_prefix("https://"));
    let is_local = |host: &str| {
        let (name, port) = host.split_once(':').unwrap_or((host, "80"));
        ["localhost", "127.0.0.1"].contains(&name) && port.parse::<u16>().is_ok()
    };
    ORIGINS.contains(&origin) || host.is_some_and(is_local)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::net::SocketAddr;

    #[test]
    fn viewers_come_in_and_strangers_do_not() {
        // Viewers: known ones, and servers of this machine.
        for origin in [
            "https://app.foxglove.dev",
            "file://",
            "http://localhost",
            "http://localhost:8080",
            "https://localhost:1",
            "http://127.0.0.1:65535",
        ] {
            assert!(is_viewer(origin), "{origin}");
        }
        // Strangers, some of whom look like them.
        for origin in [
            "",
            "null",
            "http://app.foxglove.dev",
            "https://app.foxglove.dev.evil.example",
            "https://evil.example",
            "http://localhost.evil.example",
            "http://localhost:8080.evil.example",
            "http://localhost:",
            "http://user@localhost:8080",
            "http://127.0.0.2:8080",
            "file:///tmp",
            "ws://localhost:8765",
        ] {
            assert!(!is_viewer(origin), "{origin}");
        }
    }

    #[test]
    fn the_token_is_asked_of_those_that_command_and_a_wrong_one_is_refused() {
        let admission = Admission::new(SocketAddr::from(([127, 0, 0, 1], 8720))).unwrap();
        let door = admission.at(SocketAddr::from(([127, 0, 0, 1], 8765)));
        let url = door.viewer_url();
        let own = url.strip_prefix("ws://127.0.0.1:8765/?token=").unwrap();
        let ask = |host: &'static str, origin: Option<&[u8]>, token: Option<&str>| {
            let mut headers = HeaderMap::from_iter([(header::HOST, host.parse().unwrap())]);
            if let Some(origin) = origin {
                headers.insert(header::ORIGIN, axum::http::HeaderValue::from_bytes(origin).unwrap());
            }
            admit(&door, &headers, token)
        };
        assert_eq!(ask("localhost:8765", None, None), Ok(false));
        assert_eq!(ask("127.0.0.1:8765", Some(b"file://"), Some(own)), Ok(true));
        assert!(ask("127.0.0.1:8765", None, Some("")).unwrap_err().contains("token"));
        assert!(ask("127.0.0.1:8720", None, Some(own)).unwrap_err().contains("name"));
        assert!(ask("evil.example:8765", None, None).unwrap_err().contains("name"));
        assert!(ask("127.0.0.1:8765", Some(b"http://evil.example"), Some(own)).is_err());
        assert!(ask("127.0.0.1:8765", Some(b"\xff"), Some(own)).is_err(), "unreadable is not absent");
        assert!(admit(&door, &HeaderMap::new(), Some(own)).is_err());
    }
}

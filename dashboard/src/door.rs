//! HTTP: the page, the book, the robot's outlines, and the door to the socket. On the loopback interface, for requests that name this server.

use std::collections::VecDeque;
use std::sync::Arc;
use std::time::Duration;

use axum::Router;
use axum::extract::ws::WebSocketUpgrade;
use axum::extract::ws::rejection::WebSocketUpgradeRejection;
use axum::extract::{RawQuery, Request, State};
use axum::http::{HeaderMap, HeaderName, HeaderValue, StatusCode, Uri, header};
use axum::middleware::Next;
use axum::response::{IntoResponse, Redirect, Response};
use axum::routing::get;
use hyper::server::conn::http1;
use hyper_util::rt::{TokioIo, TokioTimer};
use hyper_util::service::TowerToHyperService;
use tokio::net::TcpListener;
use tokio::sync::watch;
use tokio::task::JoinHandle;

use crate::admission::Admission;
use crate::book::{self, BookAnswer};
use crate::description::RobotFiles;
use crate::impatient::Impatient;
use crate::page;
use crate::requests::LONGEST;
use crate::socket::{self, MOST_SOCKETS, PATIENCE, Sockets};

/// Connections at once that have not become sockets.
const MOST_CONNECTIONS: usize = 128;
/// Time for the head of a request.
const HEAD_TIME: Duration = Duration::from_secs(5);
/// Bytes that wait for one page inside the server, besides its queue.
pub(crate) const WRITE_BUFFER: usize = 1 << 20;

/// No foreign origin, no inline script, no frame; styles may be set by the page's own elements.
const POLICY: &str = "default-src 'none'; script-src 'self'; style-src 'self' 'unsafe-inline'; img-src 'self' data: blob:; \
                      connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'";
const HEADERS: [(HeaderName, &str); 5] = [
    (header::CONTENT_SECURITY_POLICY, POLICY),
    (header::X_CONTENT_TYPE_OPTIONS, "nosniff"),
    (header::CACHE_CONTROL, "no-store"),
    (header::REFERRER_POLICY, "no-referrer"),
    (HeaderName::from_static("cross-origin-resource-policy"), "same-origin"),
];

/// Door of the server: who comes in, and what there is.
#[derive(Debug)]
pub struct Door {
    /// Who comes in.
    pub admission: Admission,
    /// Shared state of the sockets.
    pub sockets: Arc<Sockets>,
    /// Files of the running robot.
    pub files: watch::Receiver<RobotFiles>,
}

/// Everything behind the door.
pub fn router(door: Door) -> Router {
    let door = Arc::new(door);
    let guard = axum::middleware::from_fn_with_state(door.clone(), guard);
    Router::new().route("/socket", get(enter)).fallback(get(file)).layer(guard).with_state(door)
}

/// Serves connections for ever. If there are too many, the oldest one goes that is no socket: it has had the longest time for its
/// answer, and a page that comes is not locked out by those that only stay.
pub async fn serve(listener: TcpListener, router: Router) {
    let mut open = VecDeque::new();
    loop {
        // No descriptor free: somebody must end first.
        let Ok((stream, _)) = listener.accept().await else {
            tokio::time::sleep(Duration::from_millis(100)).await;
            continue;
        };
        open.retain(|connection: &JoinHandle<()>| !connection.is_finished());
        if open.len() == MOST_CONNECTIONS
            && let Some(oldest) = open.pop_front()
        {
            oldest.abort();
        }
        let _ = stream.set_nodelay(true);
        let stream = TokioIo::new(Impatient::new(stream, PATIENCE));
        let service = TowerToHyperService::new(router.clone());
        // Ends when it becomes a socket.
        open.push_back(tokio::spawn(async move {
            let mut http = http1::Builder::new();
            http.timer(TokioTimer::new()).header_read_timeout(HEAD_TIME).max_buf_size(16 << 10);
            // What goes wrong here went wrong for that connection.
            let _ = http.serve_connection(stream, service).with_upgrades().await;
        }));
    }
}

/// Refuses requests that name another server, and puts the headers on every answer.
async fn guard(State(door): State<Arc<Door>>, request: Request, next: Next) -> Response {
    let host = text(request.headers(), header::HOST);
    let mut response = match door.admission.is_host(host) {
        true => next.run(request).await,
        false => (StatusCode::FORBIDDEN, "this server has another name\n").into_response(),
    };
    for (name, value) in HEADERS {
        response.headers_mut().insert(name, HeaderValue::from_static(value));
    }
    response
}

fn text(headers: &HeaderMap, name: HeaderName) -> Option<&str> {
    headers.get(name)?.to_str().ok()
}

/// Token of a query.
pub(crate) fn token(query: Option<&str>) -> Option<&str> {
    query?.split('&').find_map(|part| part.strip_prefix("token="))
}

/// A file of the page, of the book or of the robot.
async fn file(State(door): State<Arc<Door>>, uri: Uri) -> Response {
    let path = uri.path();
    if let Some(file) = page::FILES.iter().find(|file| file.path == path) {
        return ([(header::CONTENT_TYPE, file.kind)], file.bytes).into_response();
    }
    match book::answer(path, uri.query()) {
        Some(BookAnswer::Page(text)) => {
            return ([(header::CONTENT_TYPE, "text/html; charset=utf-8")], text).into_response();
        }
        Some(BookAnswer::File(kind, bytes)) => {
            return ([(header::CONTENT_TYPE, kind)], bytes).into_response();
        }
        Some(BookAnswer::Moved(to)) => return Redirect::permanent(to).into_response(),
        None => {}
    }
    // Files of the robot that runs now.
    let files = door.files.borrow();
    if path == "/robot.urdf" && !files.urdf.is_empty() {
        return ([(header::CONTENT_TYPE, "application/xml")], files.urdf.clone()).into_response();
    }
    let mesh = path.strip_prefix("/meshes/").and_then(|name| files.meshes.iter().find(|(n, _)| n == name));
    match mesh {
        Some((_, bytes)) => {
            ([(header::CONTENT_TYPE, "application/octet-stream")], bytes.clone()).into_response()
        }
        None => (StatusCode::NOT_FOUND, "there is no such file, or no robot runs\n").into_response(),
    }
}

/// Opens a socket for a page that is ours.
async fn enter(
    State(door): State<Arc<Door>>,
    headers: HeaderMap,
    RawQuery(query): RawQuery,
    upgrade: Result<WebSocketUpgrade, WebSocketUpgradeRejection>,
) -> Response {
    let (host, origin) = (text(&headers, header::HOST), text(&headers, header::ORIGIN));
    if !door.admission.admits(host, origin, token(query.as_deref())) {
        return (StatusCode::FORBIDDEN, "the address that `gangwerk dashboard` printed opens the page\n")
            .into_response();
    }
    let upgrade = match upgrade {
        Ok(upgrade) => upgrade,
        Err(rejection) => return rejection.into_response(),
    };
    // A place is kept until the socket ends.
    let Ok(place) = door.sockets.places.clone().try_acquire_owned() else {
        let text = format!("{MOST_SOCKETS} pages are open; close one\n");
        return (StatusCode::SERVICE_UNAVAILABLE, text).into_response();
    };
    let sockets = door.sockets.clone();
    upgrade
        .max_message_size(LONGEST)
        .max_frame_size(LONGEST)
        .read_buffer_size(2 * LONGEST)
        .write_buffer_size(0)
        .max_write_buffer_size(WRITE_BUFFER)
        .on_upgrade(move |socket| socket::serve(socket, sockets, place))
}

#[cfg(test)]
mod tests {
    use super::*;
    use axum::body::Bytes;
    use tokio::io::{AsyncReadExt, AsyncWriteExt};
    use tokio::net::TcpStream;

    /// More than the kernel keeps for a client that does not read.
    const LENGTH: usize = 32 << 20;

    /// As many clients as there are places ask for something long and do not read it; no page came in any more.
    #[tokio::test]
    async fn clients_that_do_not_read_lock_nobody_out() {
        let body = Bytes::from(vec![0; LENGTH]);
        let router = Router::new().fallback(move || std::future::ready(body.clone()));
        let listener = TcpListener::bind("127.0.0.1:0").await.unwrap();
        let address = listener.local_addr().unwrap();
        tokio::spawn(serve(listener, router));
        let ask = async || {
            let mut stream = TcpStream::connect(address).await.unwrap();
            stream.write_all(b"GET / HTTP/1.1\r\nHost: x\r\n\r\n").await.unwrap();
            let mut first = [0; 15];
            stream.read_exact(&mut first).await.map(|_| (first, stream))
        };
        let mut silent = Vec::new();
        for _ in 0..MOST_CONNECTIONS {
            silent.push(ask().await.unwrap().1);
        }
        let (first, page) = ask().await.expect("the page is served");
        assert_eq!(&first, b"HTTP/1.1 200 OK");
        // The oldest has made room.
        let mut rest = Vec::new();
        let _ = silent[0].read_to_end(&mut rest).await;
        assert!(rest.len() < LENGTH, "{} bytes", rest.len());
        drop(page);
    }
}

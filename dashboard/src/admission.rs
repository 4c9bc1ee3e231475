//! Who may come in: by Host, Origin and token.
//!
//! A browser runs pages of strangers beside ours, and they can reach the loopback interface. Host is looked at against names
//! that a stranger lets point here, Origin against his pages, the token against other users and programs of this machine.

use std::net::SocketAddr;

/// Digits of a token.
pub const DIGITS: usize = 32;

/// Conditions on a request.
#[derive(Clone, Debug)]
pub struct Admission {
    token: String,
    port: u16,
    address: SocketAddr,
}

impl Admission {
    /// For the server at `address`, with 128 bits from the operating system.
    ///
    /// # Errors
    /// The operating system has no random numbers.
    pub fn new(address: SocketAddr) -> Result<Self, String> {
        let bytes = broker::keys::nonce()?;
        let token = bytes.iter().map(|b| format!("{b:02x}")).collect();
        Ok(Self { token, port: address.port(), address })
    }

    /// Address of the page with its token, behind `#`, where no server and no log sees it.
    pub fn url(&self) -> String {
        format!("http://{}/#{}", self.address, self.token)
    }

    /// Conditions at another address of the same server: its token is the same.
    pub fn at(&self, address: SocketAddr) -> Self {
        Self { token: self.token.clone(), port: address.port(), address }
    }

    /// Address for viewers that are no page of ours, with the token.
    pub fn viewer_url(&self) -> String {
        format!("ws://{}/?token={}", self.address, self.token)
    }

    /// True if a request names this server: by its address, or as localhost.
    pub fn is_host(&self, host: Option<&str>) -> bool {
        let port = self.port;
        let own = [self.address.to_string(), format!("127.0.0.1:{port}"), format!("localhost:{port}")];
        host.is_some_and(|host| own.iter().any(|own| own == host) || host == format!("[::1]:{port}"))
    }

    /// True if a socket may be opened: the page that asks is ours, and knows the token.
    pub fn admits(&self, host: Option<&str>, origin: Option<&str>, token: Option<&str>) -> bool {
        let (Some(host), Some(origin), Some(token)) = (host, origin, token) else { return false };
        self.is_host(Some(host)) && origin.strip_prefix("http://") == Some(host) && self.is_token(token)
    }

    /// True if it is the token, in a time that does not tell how much of it is right.
    pub fn is_token(&self, token: &str) -> bool {
        let differences = self.token.bytes().zip(token.bytes()).fold(0, |sum, (a, b)| sum | (a ^ b));
        token.len() == self.token.len() && differences == 0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_the_own_page_with_the_token_comes_in() {
        let address = SocketAddr::from(([127, 0, 0, 1], 8720));
        let admission = Admission::new(address).unwrap();
        let url = admission.url();
        let token = url.split_once('#').unwrap().1;
        assert!(token.len() == DIGITS && token.bytes().all(|b| b.is_ascii_hexdigit()));
        assert_ne!(Admission::new(address).unwrap().url(), url, "each server has its own");
        let ask =
            |host: &str, origin: &str, token: &str| admission.admits(Some(host), Some(origin), Some(token));
        // Its own names, then strangers, other origins and other tokens.
        for host in ["127.0.0.1:8720", "localhost:8720", "[::1]:8720"] {
            assert!(ask(host, &format!("http://{host}"), token), "{host}");
        }
        let (host, origin) = ("127.0.0.1:8720", "http://127.0.0.1:8720");
        let wrong = format!("{}{}", &token[..DIGITS - 1], if token.ends_with('0') { '1' } else { '0' });
        for (host, origin, token) in [
            ("evil.example:8720", "http://evil.example:8720", token),
            (host, "http://evil.example", token),
            (host, "https://127.0.0.1:8720", token),
            (host, "http://localhost:8720", token),
            (host, "null", token),
            (host, origin, &wrong),
            (host, origin, &token[1..]),
            (host, origin, ""),
        ] {
            assert!(!ask(host, origin, token), "{host} {origin} {token}");
        }
        assert!(!admission.admits(None, Some(origin), Some(token)));
        assert!(!admission.admits(Some(host), None, Some(token)));
        assert!(!admission.admits(Some(host), Some(origin), None));
    }
}

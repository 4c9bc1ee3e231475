//! Messages of a viewer, checked here once.

use messages::Command;
use serde_json::{Map, Value};

use crate::requests::command;

/// Longest message of a viewer \[B\]: all parameters are followed by one that names each of them.
pub const LONGEST: usize = 64 << 10;
/// Most parameters that are set by one message.
pub const MOST_SET: usize = 64;
/// Topic of a viewer's own channel for walking commands.
pub const VELOCITY: &str = "command/velocity";
/// Encoding of a viewer's own messages.
pub const ENCODING: &str = "json";
/// First byte of a message on a viewer's own channel.
const MESSAGE: u8 = 1;

/// Text message of a viewer.
#[derive(Clone, Debug, PartialEq)]
pub enum ViewerRequest {
    /// Subscriptions: number that the viewer gives each, and channel.
    Subscribe(Vec<(u32, u32)>),
    /// Subscriptions that end.
    Unsubscribe(Vec<u32>),
    /// Channels of its own.
    Advertise(Vec<OwnChannel>),
    /// Channels of its own that end.
    Unadvertise(Vec<u32>),
    /// Values of these parameters, or of all if none is named, with the number of the request.
    Parameters(Vec<String>, Option<String>),
    /// New values of parameters, none where it is no finite number, with the number of the request.
    Set(Vec<(String, Option<f64>)>, Option<String>),
    /// Changes of these parameters, or of all, from now on.
    Follow(Vec<String>),
    /// Changes of these parameters, or of all, no longer.
    Leave(Vec<String>),
    /// A request that this server has no answer to.
    Unknown(String),
}

/// Channel on which a viewer publishes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct OwnChannel {
    /// Number that the viewer gives it.
    pub id: u32,
    /// Topic.
    pub topic: String,
    /// Encoding of its messages.
    pub encoding: String,
}

impl ViewerRequest {
    /// Reads a text message.
    ///
    /// # Errors
    /// It is none of the protocol: which part is wrong, and what it may be.
    pub fn parse(text: &str) -> Result<Self, String> {
        let value: Value = serde_json::from_str(text).map_err(|e| format!("no JSON: {e}"))?;
        let id = value["id"].as_str().map(str::to_owned);
        let names = || list(&value, "parameterNames", "texts", name);
        Ok(match value["op"].as_str().ok_or("op: a text is needed")? {
            "subscribe" => {
                Self::Subscribe(list(&value, "subscriptions", "{id, channelId}, whole numbers", |each| {
                    Some((number(&each["id"])?, number(&each["channelId"])?))
                })?)
            }
            "unsubscribe" => Self::Unsubscribe(list(&value, "subscriptionIds", "whole numbers", number)?),
            "advertise" => Self::Advertise(list(&value, "channels", "{id, topic, encoding}", own_channel)?),
            "unadvertise" => Self::Unadvertise(list(&value, "channelIds", "whole numbers", number)?),
            // Parameters.
            "getParameters" => Self::Parameters(names()?, id),
            "setParameters" => {
                let new = |each: &Value| Some((name(&each["name"])?, each["value"].as_f64()));
                let set = list(&value, "parameters", "{name, value}", new)?;
                if set.len() > MOST_SET {
                    return Err(format!("parameters: {} of them, at most {MOST_SET} at once", set.len()));
                }
                Self::Set(set, id)
            }
            "subscribeParameterUpdates" => Self::Follow(names()?),
            "unsubscribeParameterUpdates" => Self::Leave(names()?),
            other => Self::Unknown(other.to_owned()),
        })
    }
}

/// Every element of a list.
fn list<T>(
    value: &Value,
    key: &str,
    what: &str,
    read: impl Fn(&Value) -> Option<T>,
) -> Result<Vec<T>, String> {
    let all = value[key].as_array().and_then(|list| list.iter().map(read).collect());
    all.ok_or_else(|| format!("{key}: a list is needed, of {what}"))
}

fn number(value: &Value) -> Option<u32> {
    u32::try_from(value.as_u64()?).ok()
}

fn name(value: &Value) -> Option<String> {
    value.as_str().map(str::to_owned)
}

fn own_channel(value: &Value) -> Option<OwnChannel> {
    let (topic, encoding) = (name(&value["topic"])?, name(&value["encoding"])?);
    Some(OwnChannel { id: number(&value["id"])?, topic, encoding })
}

/// Channel and content of a binary message.
///
/// # Errors
/// It is not a message on a channel.
pub fn published(bytes: &[u8]) -> Result<(u32, &[u8]), String> {
    match bytes.split_first_chunk::<5>() {
        Some(([MESSAGE, a, b, c, d], content)) => Ok((u32::from_le_bytes([*a, *b, *c, *d]), content)),
        _ => Err("a binary frame is a message on a channel: 1, u32 channel, content".into()),
    }
}

/// Walking command of a message on [`VELOCITY`]: `{forward, left, turn}`, or `geometry_msgs/Twist`, of which `linear.x`, `linear.y`
/// and `angular.z` count \[m/s, m/s, rad/s\].
///
/// # Errors
/// It is no JSON object, or names a field that the command has not, or a value outside of its range.
pub fn velocity(content: &[u8]) -> Result<Command, String> {
    let value: Value = serde_json::from_slice(content).map_err(|e| format!("{VELOCITY}: no JSON: {e}"))?;
    let values = value.as_object().ok_or_else(|| format!("{VELOCITY}: no JSON object"))?;
    if !values.contains_key("linear") && !values.contains_key("angular") {
        return command("walk/velocity", values);
    }
    let parts = [("forward", "linear", "x"), ("left", "linear", "y"), ("turn", "angular", "z")];
    let given = parts.iter().filter_map(|(field, part, axis)| {
        let number = value[part].get(axis)?;
        Some(((*field).to_owned(), number.clone()))
    });
    command("walk/velocity", &given.collect::<Map<_, _>>())
}

#[cfg(test)]
mod tests {
    use super::*;
    use messages::command::VelocityCommand;

    #[test]
    fn messages_of_the_protocol_are_read() {
        let names = |list: &[&str]| list.iter().map(|name| (*name).to_owned()).collect::<Vec<_>>();
        let own = OwnChannel { id: 1, topic: VELOCITY.into(), encoding: "json".into() };
        // Each as Foxglove's clients write it.
        for (text, request) in [
            (
                r#"{"op":"subscribe","subscriptions":[{"id":0,"channelId":3},{"id":1,"channelId":5}]}"#,
                ViewerRequest::Subscribe(vec![(0, 3), (1, 5)]),
            ),
            (r#"{"op":"unsubscribe","subscriptionIds":[0,1]}"#, ViewerRequest::Unsubscribe(vec![0, 1])),
            (
                r#"{"op":"advertise","channels":[{"id":1,"topic":"command/velocity","encoding":"json","schemaName":"x"}]}"#,
                ViewerRequest::Advertise(vec![own]),
            ),
            (r#"{"op":"unadvertise","channelIds":[1]}"#, ViewerRequest::Unadvertise(vec![1])),
            (
                r#"{"op":"getParameters","parameterNames":["a","b"],"id":"7"}"#,
                ViewerRequest::Parameters(names(&["a", "b"]), Some("7".into())),
            ),
            (
                r#"{"op":"setParameters","parameters":[{"name":"a","value":2,"type":"float64"},{"name":"b","value":"2"}]}"#,
                ViewerRequest::Set(vec![("a".into(), Some(2.0)), ("b".into(), None)], None),
            ),
            (
                r#"{"op":"subscribeParameterUpdates","parameterNames":["a"]}"#,
                ViewerRequest::Follow(names(&["a"])),
            ),
            (r#"{"op":"unsubscribeParameterUpdates","parameterNames":[]}"#, ViewerRequest::Leave(Vec::new())),
            (
                r#"{"op":"subscribeConnectionGraph"}"#,
                ViewerRequest::Unknown("subscribeConnectionGraph".into()),
            ),
        ] {
            assert_eq!(ViewerRequest::parse(text), Ok(request), "{text}");
        }
    }

    #[test]
    fn what_is_wrong_is_named() {
        let set = vec![r#"{"name":"a","value":1}"#; MOST_SET + 1].join(",");
        for (text, named) in [
            ("", "no JSON"),
            ("[]", "op"),
            (r#"{"op":7}"#, "op"),
            (r#"{"op":"subscribe"}"#, "subscriptions"),
            (r#"{"op":"subscribe","subscriptions":[{"id":-1,"channelId":3}]}"#, "whole numbers"),
            (r#"{"op":"subscribe","subscriptions":[{"id":4294967296,"channelId":3}]}"#, "whole numbers"),
            (r#"{"op":"unsubscribe","subscriptionIds":{}}"#, "subscriptionIds"),
            (r#"{"op":"advertise","channels":[{"id":1,"topic":"x"}]}"#, "encoding"),
            (r#"{"op":"getParameters","parameterNames":[1]}"#, "parameterNames"),
            (&format!(r#"{{"op":"setParameters","parameters":[{set}]}}"#), "at most 64"),
        ] {
            let error = ViewerRequest::parse(text).unwrap_err();
            assert!(error.contains(named), "{text}: {error}");
        }
        for bytes in [&[][..], &[1, 0, 0, 0], &[2, 0, 0, 0, 0]] {
            assert!(published(bytes).is_err(), "{bytes:?}");
        }
    }

    #[test]
    fn both_forms_of_a_velocity_are_the_command() {
        let message = [&[1, 7, 0, 0, 0][..], br#"{"forward":0.3,"turn":-0.1}"#].concat();
        let (channel, content) = published(&message).unwrap();
        let walk = Command::Velocity(VelocityCommand { forward: 0.3, left: 0.0, turn: -0.1 });
        assert_eq!((channel, velocity(content)), (7, Ok(walk)));
        let twist = br#"{"linear":{"x":0.3,"y":0,"z":9},"angular":{"x":9,"y":9,"z":-0.1}}"#;
        assert_eq!(velocity(twist), Ok(walk));
        for (content, named) in [
            ("{", "no JSON"),
            ("7", "no JSON object"),
            (r#"{"forward":9}"#, "[-2, 2]"),
            (r#"{"forwrd":0.1}"#, "forward"),
            (r#"{"linear":{"x":"fast"}}"#, "a number"),
        ] {
            let error = velocity(content.as_bytes()).unwrap_err();
            assert!(error.contains(named), "{error}");
        }
    }
}

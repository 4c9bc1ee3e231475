//! Messages to a viewer. Numbers of binary ones are little endian.

use recording::LogChannel;
use recording::composer::{ENCODING, SCHEMA_ENCODING};
use serde_json::{Value, json};

use crate::foxglove::requests;

/// First bytes of binary messages.
const MESSAGE: u8 = 1;
const TIME: u8 = 2;

/// Urgency of a [`status`].
#[derive(Clone, Copy, Debug)]
#[repr(u8)]
pub enum StatusLevel {
    /// Something is missing for the time being.
    Warning = 1,
    /// A request is refused.
    Error = 2,
}

/// Description of this server; `session` is another one after each start of it.
pub fn server_info(session: &str) -> String {
    json!({
        "op": "serverInfo", "name": "Gangwerk", "sessionId": session, "metadata": {},
        "capabilities": ["clientPublish", "parameters", "parametersSubscribe", "time"],
        "supportedEncodings": [requests::ENCODING],
    })
    .to_string()
}

/// Channels, by their places in the table.
pub fn advertise(channels: &[LogChannel]) -> String {
    let channel = |(id, channel): (usize, &LogChannel)| {
        json!({
            "id": id, "topic": channel.name, "encoding": ENCODING,
            "schemaName": channel.interface, "schema": channel.definition, "schemaEncoding": SCHEMA_ENCODING,
        })
    };
    let channels: Vec<Value> = channels.iter().enumerate().map(channel).collect();
    json!({"op": "advertise", "channels": channels}).to_string()
}

/// A sentence for whoever sits in front of the viewer.
pub fn status(level: StatusLevel, message: &str) -> String {
    json!({"op": "status", "level": level as u8, "message": message}).to_string()
}

/// Values of parameters; `id`: of the request that it answers.
pub fn parameter_values(values: &[(String, f64)], id: Option<&str>) -> String {
    // Also whole numbers are of this type.
    let value = |(name, value): &(String, f64)| json!({"name": name, "value": value, "type": "float64"});
    let mut message =
        json!({"op": "parameterValues", "parameters": values.iter().map(value).collect::<Vec<_>>()});
    if let Some(id) = id {
        message["id"] = id.into();
    }
    message.to_string()
}

/// A message of a subscription at a time of the log \[ns\].
pub fn message(subscription: u32, time_ns: u64, payload: &[u8]) -> Vec<u8> {
    let mut bytes = Vec::with_capacity(13 + payload.len());
    bytes.push(MESSAGE);
    bytes.extend(subscription.to_le_bytes());
    bytes.extend(time_ns.to_le_bytes());
    bytes.extend(payload);
    bytes
}

/// Time of the log \[ns\], as that of all messages until the next one.
pub fn time(time_ns: u64) -> Vec<u8> {
    let mut bytes = vec![TIME];
    bytes.extend(time_ns.to_le_bytes());
    bytes
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn binary_messages_are_the_specification_s() {
        assert_eq!(message(0x0102, 3, &[9, 8]), [1, 2, 1, 0, 0, 3, 0, 0, 0, 0, 0, 0, 0, 9, 8]);
        assert_eq!(time(0x0405), [2, 5, 4, 0, 0, 0, 0, 0, 0]);
    }

    #[test]
    fn an_answer_carries_the_number_of_its_request_and_nothing_else_does() {
        let values = [("planner.swing_height".to_owned(), 0.06)];
        let answer: Value = serde_json::from_str(&parameter_values(&values, Some("7"))).unwrap();
        let parameter = json!({"name": "planner.swing_height", "value": 0.06, "type": "float64"});
        assert_eq!((&answer["id"], &answer["parameters"]), (&json!("7"), &json!([parameter])));
        assert!(!parameter_values(&values, None).contains("id"));
    }
}

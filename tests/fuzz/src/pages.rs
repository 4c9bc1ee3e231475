//! Messages of pages and of viewers of the second door.

use dashboard::foxglove::requests::{MOST_SET, VELOCITY, ViewerRequest, published, velocity};
use dashboard::requests::{LONGEST_WINDOW, Order, PageRequest, RATES, RecordingRequest};
use messages::Command;
use messages::command_text::COMMANDS;

/// One JSON object: a command that is taken is in range, and so is a rate.
pub(crate) fn page(bytes: &[u8]) {
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    match PageRequest::parse(text) {
        Ok(PageRequest::Order(Order::Command(_, Ok(command)))) => assert_eq!(command.check(), Ok(())),
        Ok(PageRequest::Plot(_, rate)) => assert!((RATES[0]..=RATES[1]).contains(&rate), "{rate}"),
        Ok(PageRequest::Recording(RecordingRequest::Window(log, [from, to]))) => {
            assert!(log < 2 && (0.0..=LONGEST_WINDOW).contains(&(to - from)), "{log}, {from}, {to}");
        }
        Ok(PageRequest::Order(Order::Set(_, _, value))) => assert!(value.is_finite()),
        _ => {}
    }
}

pub(crate) fn page_seeds() -> Vec<Vec<u8>> {
    let mut seeds = [
        r#"{"type":"pulse"}"#,
        r#"{"type":"emergency_stop","id":3}"#,
        r#"{"type":"set","id":4,"name":"controller.force.x","value":0.5}"#,
        r#"{"type":"lease","id":5,"take":true,"over":true}"#,
        r#"{"type":"plot","fields":["sensors.time"],"rate":60}"#,
        r#"{"type":"start","id":6,"scene":"walk_1kmh","depth":3,"integrator":"euler"}"#,
        r#"{"type":"end","id":7}"#,
        r#"{"type":"seek","time":1.5,"other":2.5}"#,
        r#"{"type":"window","log":1,"from":0.5,"to":1.5}"#,
    ]
    .map(|seed| seed.as_bytes().to_vec())
    .to_vec();
    seeds.extend(COMMANDS.iter().map(|info| {
        let fields = fields(&info.example(), info.fields.iter().map(|field| field.name));
        format!(r#"{{"type":"command","id":1,"name":"{}","values":{{{fields}}}}}"#, info.name).into_bytes()
    }));
    seeds
}

/// Text or binary message of the Foxglove protocol: what is taken is bounded and in range.
pub(crate) fn viewer(bytes: &[u8]) {
    if let Ok(text) = std::str::from_utf8(bytes)
        && let Ok(ViewerRequest::Set(values, _)) = ViewerRequest::parse(text)
    {
        assert!(values.len() <= MOST_SET);
        assert!(values.iter().filter_map(|(_, value)| *value).all(f64::is_finite));
    }
    if let Ok((_, content)) = published(bytes)
        && let Ok(command) = velocity(content)
    {
        assert!(matches!(command, Command::Velocity(_)));
        assert_eq!(command.check(), Ok(()));
    }
}

pub(crate) fn viewer_seeds() -> Vec<Vec<u8>> {
    let advertise = format!(
        r#"{{"op":"advertise","channels":[{{"id":1,"topic":"{VELOCITY}","encoding":"json","schemaName":"x"}}]}}"#
    );
    let texts = [
        r#"{"op":"subscribe","subscriptions":[{"id":0,"channelId":3},{"id":1,"channelId":5}]}"#,
        r#"{"op":"unsubscribe","subscriptionIds":[0,1]}"#,
        &advertise,
        r#"{"op":"getParameters","parameterNames":["a","b"],"id":"7"}"#,
        r#"{"op":"setParameters","parameters":[{"name":"a","value":2,"type":"float64"}]}"#,
        r#"{"op":"subscribeParameterUpdates","parameterNames":[]}"#,
        "\x01\x07\0\0\0{\"forward\":0.3,\"turn\":-0.1}",
        "\x01\x07\0\0\0{\"linear\":{\"x\":0.3,\"y\":0},\"angular\":{\"z\":-0.1}}",
    ];
    texts.map(|seed| seed.as_bytes().to_vec()).to_vec()
}

/// `"NAME":VALUE,...`
fn fields<'a>(command: &Command, names: impl Iterator<Item = &'a str>) -> String {
    let each = names.enumerate().map(|(i, name)| format!(r#""{name}":{}"#, command.value(i)));
    each.collect::<Vec<_>>().join(",")
}

//! Requests of a page: one JSON object each, checked here once.

use config::method::Integrator;
use messages::Command;
use serde_json::{Map, Value};

/// Longest message of a page \[B\].
pub const LONGEST: usize = 4096;
/// Most fields of one plot.
pub const MOST_FIELDS: usize = 64;
/// Least and greatest rate of a plot \[1/s\].
pub const RATES: [f64; 2] = [1.0, 1000.0];

/// Longest stretch of a recording of which samples are sent at once \[s\].
pub const LONGEST_WINDOW: f64 = 60.0;

/// One message of a page.
#[derive(Clone, Debug, PartialEq)]
pub enum PageRequest {
    /// Fields to be sent as samples from now on, and their rate \[1/s\].
    Plot(Vec<String>, f64),
    /// For the broker.
    Order(Order),
    /// Supply off, now; its number.
    EmergencyStop(u64),
    /// Start or end of a run, by its number, or why it cannot be.
    Run(u64, Result<RunTask, String>),
    /// Request for a part of a recording.
    Recording(RecordingRequest),
}

/// Task for the starter.
#[derive(Clone, Debug, PartialEq)]
pub enum RunTask {
    /// Start of a run.
    Start(StartOrder),
    /// End of the run that was started here.
    End,
}

/// Run that a page wants.
#[derive(Clone, Debug, PartialEq)]
pub struct StartOrder {
    /// Name of a scene, which the catalogue may have.
    pub scene: String,
    /// Modelling depth, 1 to 5; none: the scene's.
    pub depth: Option<u8>,
    /// Integrator; none: the scene's, or the one made for another depth.
    pub integrator: Option<Integrator>,
}

/// Part of a recording that a page wants.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum RecordingRequest {
    /// State at an instant of the log, and of the other one \[s\]; none: the other one is not seen.
    Seek(f64, Option<f64>),
    /// Samples of the plotted fields of a log (0, or 1: the other one), from one instant to before another one \[s\].
    Window(usize, [f64; 2]),
}

/// Order for the broker.
#[derive(Clone, Debug, PartialEq)]
pub enum Order {
    /// A command, by its number, or why there is none.
    Command(u64, Result<Command, String>),
    /// A parameter and its new value.
    Set(u64, String, f64),
    /// The command lease; true: also from somebody who holds it.
    TakeLease(u64, bool),
    /// The command lease is given back.
    GiveLease(u64),
    /// Heartbeat.
    Pulse,
}

impl Order {
    /// Number under which it is answered; none: it is not.
    pub fn id(&self) -> Option<u64> {
        match self {
            Self::Command(id, _) | Self::Set(id, ..) | Self::TakeLease(id, _) | Self::GiveLease(id) => {
                Some(*id)
            }
            Self::Pulse => None,
        }
    }

    /// Whether it can only bring the robot to rest, however old it is. A stop of one's own walk is a velocity of zero, too.
    pub fn only_stops(&self) -> bool {
        match self {
            Self::Command(_, Ok(command)) => {
                command.always_passes() || matches!(command, Command::Velocity(_)) && !command.is_unbounded()
            }
            Self::GiveLease(_) => true,
            _ => false,
        }
    }
}

impl PageRequest {
    /// Reads a message.
    ///
    /// # Errors
    /// It is none of `docs/dashboard.md`: which field is wrong, and what it may be. A command or run that does not exist or is out
    /// of range is one of the page all the same, to be answered.
    pub fn parse(text: &str) -> Result<Self, String> {
        let value: Value = serde_json::from_str(text).map_err(|e| format!("no JSON: {e}"))?;
        let object = value.as_object().ok_or("no JSON object")?;
        let whole = |key: &str| {
            let number = object.get(key).and_then(Value::as_u64);
            number.ok_or_else(|| format!("{key}: a whole number is needed"))
        };
        let number = |key: &str| {
            let number = object.get(key).and_then(Value::as_f64).filter(|x| x.is_finite());
            number.ok_or_else(|| format!("{key}: a number is needed"))
        };
        let text = |key: &str| {
            object.get(key).and_then(Value::as_str).ok_or_else(|| format!("{key}: a text is needed"))
        };
        // A flag that is left out is not set.
        let flag = |key: &str| object.get(key).and_then(Value::as_bool).unwrap_or(false);
        Ok(match text("type")? {
            "pulse" => Self::Order(Order::Pulse),
            "emergency_stop" => Self::EmergencyStop(whole("id")?),
            "command" => {
                let values = object.get("values").and_then(Value::as_object);
                let command = command(text("name")?, values.unwrap_or(&Map::new()));
                Self::Order(Order::Command(whole("id")?, command))
            }
            "start" => Self::Run(whole("id")?, start(object).map(RunTask::Start)),
            "end" => Self::Run(whole("id")?, Ok(RunTask::End)),
            "set" => Self::Order(Order::Set(whole("id")?, text("name")?.to_owned(), number("value")?)),
            "lease" if flag("give") => Self::Order(Order::GiveLease(whole("id")?)),
            "lease" if flag("take") => Self::Order(Order::TakeLease(whole("id")?, flag("over"))),
            "lease" => return Err("lease: take or give is needed".into()),
            // Samples: of a running robot from now on, of a recording when a window is asked for.
            "plot" => plot(object.get("fields"), number("rate"))?,
            "seek" => {
                let other = object.get("other").is_some_and(|other| !other.is_null());
                let other = other.then(|| number("other")).transpose()?;
                Self::Recording(RecordingRequest::Seek(number("time")?, other))
            }
            "window" => window(whole("log")?, [number("from")?, number("to")?])?,
            other => {
                let known = [
                    "pulse",
                    "emergency_stop",
                    "command",
                    "start",
                    "end",
                    "set",
                    "lease",
                    "plot",
                    "seek",
                    "window",
                ];
                return Err(messages::unknown("type", other, &known, "docs/dashboard.md has them all"));
            }
        })
    }
}

fn start(object: &Map<String, Value>) -> Result<StartOrder, String> {
    // Null is as absent: as the scene says.
    let given = |key: &str| object.get(key).filter(|value| !value.is_null());
    let depth = |value: &Value| {
        let depth = value.as_u64().and_then(|depth| u8::try_from(depth).ok());
        depth.filter(|d| (1..=5).contains(d)).ok_or_else(|| format!("depth: {value} is none of 1 to 5"))
    };
    Ok(StartOrder {
        scene: given("scene").and_then(Value::as_str).ok_or("scene: a name is needed")?.to_owned(),
        depth: given("depth").map(depth).transpose()?,
        integrator: given("integrator")
            .map(|word| word.as_str().unwrap_or_default().parse::<Integrator>())
            .transpose()?,
    })
}

fn plot(fields: Option<&Value>, rate: Result<f64, String>) -> Result<PageRequest, String> {
    let list = fields.and_then(Value::as_array).ok_or("fields: a list of names is needed")?;
    if list.len() > MOST_FIELDS {
        return Err(format!("fields: {} of them, at most {MOST_FIELDS} are sent", list.len()));
    }
    if list.is_empty() {
        return Ok(PageRequest::Plot(Vec::new(), RATES[1]));
    }
    let names: Option<Vec<String>> = list.iter().map(|name| Some(name.as_str()?.to_owned())).collect();
    let (rate, [low, high]) = (rate?, RATES);
    if !(low..=high).contains(&rate) {
        return Err(format!("rate: {rate} is outside of [{low}, {high}] 1/s"));
    }
    Ok(PageRequest::Plot(names.ok_or("fields: each must be a text")?, rate))
}

fn window(log: u64, [from, to]: [f64; 2]) -> Result<PageRequest, String> {
    let log = usize::try_from(log).ok().filter(|log| *log < 2).ok_or("log: 0 or 1 is needed")?;
    let length = to - from;
    if !(0.0..=LONGEST_WINDOW).contains(&length) {
        return Err(format!("from, to: a stretch of {length} s is outside of [0, {LONGEST_WINDOW}] s"));
    }
    Ok(PageRequest::Recording(RecordingRequest::Window(log, [from, to])))
}

/// The command of that name with these numbers.
pub(crate) fn command(name: &str, values: &Map<String, Value>) -> Result<Command, String> {
    let mut fields = String::new();
    for (key, value) in values {
        // As text of a command line, which the one parser of commands reads: nothing may end a word early.
        if !key.bytes().all(|b| b.is_ascii_alphanumeric() || b"._".contains(&b)) {
            return Err(format!("{name}: {key:?} is no name of a field"));
        }
        let number = value.as_f64().ok_or_else(|| format!("{name}: {key} = {value}: a number is needed"))?;
        fields += &format!("{key}={number:?} ");
    }
    Command::parse(name, fields.trim_end())
}

#[cfg(test)]
mod tests {
    use super::*;
    use messages::command::VelocityCommand;

    fn parse(text: &str) -> Result<PageRequest, String> {
        PageRequest::parse(text)
    }

    #[test]
    fn messages_of_the_protocol_are_read() {
        let velocity = Command::Velocity(VelocityCommand { forward: 0.3, left: 0.0, turn: -0.1 });
        let command =
            r#"{"type":"command","id":7,"name":"walk/velocity","values":{"forward":0.3,"turn":-0.1}}"#;
        assert_eq!(parse(command), Ok(PageRequest::Order(Order::Command(7, Ok(velocity)))));
        let plot = r#"{"type":"plot","fields":["sensors.power"],"rate":500}"#;
        assert_eq!(parse(plot), Ok(PageRequest::Plot(vec!["sensors.power".into()], 500.0)));
        let set = r#"{"type":"set","id":8,"name":"planner.swing_height","value":0.06}"#;
        assert_eq!(parse(set), Ok(PageRequest::Order(Order::Set(8, "planner.swing_height".into(), 0.06))));
        let take = r#"{"type":"lease","id":9,"take":true,"over":true}"#;
        assert_eq!(parse(take), Ok(PageRequest::Order(Order::TakeLease(9, true))));
        assert_eq!(parse(r#"{"type":"pulse"}"#), Ok(PageRequest::Order(Order::Pulse)));
        assert_eq!(parse(r#"{"type":"emergency_stop","id":1}"#), Ok(PageRequest::EmergencyStop(1)));
        // Runs: as the scene says, and with another model.
        let run = |depth, integrator| {
            let order = StartOrder { scene: "demo".into(), depth, integrator };
            Ok(PageRequest::Run(2, Ok(RunTask::Start(order))))
        };
        assert_eq!(parse(r#"{"type":"start","id":2,"scene":"demo","depth":null}"#), run(None, None));
        let deep = r#"{"type":"start","id":2,"scene":"demo","depth":3,"integrator":"semi_implicit"}"#;
        assert_eq!(parse(deep), run(Some(3), Some(Integrator::SemiImplicit)));
        assert_eq!(parse(r#"{"type":"end","id":3}"#), Ok(PageRequest::Run(3, Ok(RunTask::End))));
        let seek = |time, other| Ok(PageRequest::Recording(RecordingRequest::Seek(time, other)));
        assert_eq!(parse(r#"{"type":"seek","time":12.345}"#), seek(12.345, None));
        assert_eq!(parse(r#"{"type":"seek","time":-1,"other":2.5}"#), seek(-1.0, Some(2.5)));
        let window = PageRequest::Recording(RecordingRequest::Window(1, [2.0, 4.5]));
        assert_eq!(parse(r#"{"type":"window","log":1,"from":2,"to":4.5}"#), Ok(window));
    }

    /// Each error names its field; a command that cannot be is one with an answer.
    #[test]
    fn what_is_wrong_is_named() {
        let fields = vec!["\"f\""; MOST_FIELDS + 1].join(",");
        for (text, named) in [
            ("", "no JSON"),
            ("[1]", "no JSON object"),
            ("{}", "type"),
            (r#"{"type":"puls"}"#, "pulse"),
            (r#"{"type":"emergency_stop","id":-1}"#, "id"),
            (r#"{"type":"start","scene":"demo"}"#, "id"),
            (r#"{"type":"set","id":1,"name":"k","value":"1"}"#, "value"),
            (r#"{"type":"set","id":1,"name":"k","value":1e999}"#, "JSON"),
            (r#"{"type":"lease","id":1}"#, "take or give"),
            (r#"{"type":"seek","time":null}"#, "time"),
            (r#"{"type":"seek","time":1,"other":"x"}"#, "other"),
            (r#"{"type":"window","log":2,"from":0,"to":1}"#, "0 or 1"),
            (r#"{"type":"window","log":0,"from":0,"to":60.1}"#, "60.1 s"),
            (r#"{"type":"window","log":0,"from":1,"to":0}"#, "-1 s"),
            (r#"{"type":"plot","fields":["f"],"rate":1001}"#, "rate"),
            (r#"{"type":"plot","fields":[7],"rate":10}"#, "text"),
            (&format!(r#"{{"type":"plot","fields":[{fields}],"rate":10}}"#), "65 of them"),
        ] {
            let error = parse(text).unwrap_err();
            assert!(error.contains(named), "{text}: {error}");
        }
        // Runs and commands are answered with the reason.
        for (start, named) in [
            (r#""scene":7"#, "scene"),
            (r#""scene":"demo","depth":6"#, "6 is none of 1 to 5"),
            (r#""scene":"demo","depth":257"#, "257"),
            (r#""scene":"demo","depth":"2""#, "depth"),
            (r#""scene":"demo","integrator":"--bus""#, "semi_implicit"),
        ] {
            match parse(&format!(r#"{{"type":"start","id":3,{start}}}"#)) {
                Ok(PageRequest::Run(3, Err(reason))) => assert!(reason.contains(named), "{start}: {reason}"),
                other => panic!("{start}: {other:?}"),
            }
        }
        let reason = |values: &str| {
            let text = format!(r#"{{"type":"command","id":3,"name":"walk/velocity","values":{values}}}"#);
            match parse(&text) {
                Ok(PageRequest::Order(Order::Command(3, Err(reason)))) => reason,
                other => panic!("{text}: {other:?}"),
            }
        };
        assert!(reason(r#"{"forward":9}"#).contains("[-2, 2]"));
        assert!(reason(r#"{"forwrd":0.1}"#).contains("forward"));
        assert!(reason(r#"{"forward":"0.1"}"#).contains("a number"));
        assert!(reason(r#"{"forward=0.1 turn":0.1}"#).contains("no name"));
    }
}

//! Requests of the master to a station before operation: parameters in CP2, checks before CP3 and CP4.

use crate::header::{Kind, Phase};
use crate::idn::{self, COMMAND, FEEDBACK, connection};
use crate::layout::{CONNECTION, Layout, Station};
use crate::parameters::Value;
use crate::service::Request;

/// Data for all stations.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Timing {
    /// Cycle time \[ns\].
    pub cycle: u32,
    /// Losses in a row that are permitted: of the data of a connection.
    pub losses: u16,
    /// Losses in a row that are permitted: of beats.
    pub beat_losses: u16,
}

/// Requests of a phase for station `i`.
pub(crate) fn requests(
    phase: Phase,
    timing: Timing,
    stations: &[Station],
    layout: &Layout,
    i: usize,
) -> Vec<Request> {
    match phase {
        Phase::Cp2 => {
            let mut all = communication(timing, &stations[i], layout, i);
            all.extend(connections(timing, &stations[i], layout, i));
            all.push(Request::Execute(idn::CHECK_CP3));
            all
        }
        Phase::Cp3 => vec![Request::Execute(idn::CHECK_CP4)],
        Phase::Cp0 | Phase::Cp1 | Phase::Cp4 => Vec::new(),
    }
}

fn communication(timing: Timing, station: &Station, layout: &Layout, i: usize) -> Vec<Request> {
    let places = &layout.places[i];
    let lengths = |all: [usize; 4]| Value::words(all.map(|len| len as u16));
    vec![
        Request::Expect(idn::ADDRESS, Value::word(station.address)),
        Request::Write(idn::CYCLE_TIME, Value::long(timing.cycle)),
        // The ATs follow the MDTs at once: nothing waits for a time within the cycle.
        Request::Write(idn::AT_TIME, Value::long(0)),
        Request::Write(idn::BEAT_LOSSES, Value::word(timing.beat_losses)),
        Request::Write(idn::CONTROL_OFFSET, Value::word(places.control.word(Kind::Mdt))),
        Request::Write(idn::MDT_LENGTHS, lengths(layout.mdt)),
        Request::Write(idn::STATUS_OFFSET, Value::word(places.status.word(Kind::At))),
        Request::Write(idn::AT_LENGTHS, lengths(layout.at)),
        Request::Write(idn::MDT_SERVICE_OFFSET, Value::word(places.mdt_service.word(Kind::Mdt))),
        Request::Write(idn::AT_SERVICE_OFFSET, Value::word(places.at_service.word(Kind::At))),
    ]
}

fn connections(timing: Timing, station: &Station, layout: &Layout, i: usize) -> Vec<Request> {
    let places = &layout.places[i];
    let command = (COMMAND, idn::CONSUMER, station.command, places.command.word(Kind::Mdt));
    let feedback = (FEEDBACK, idn::PRODUCER, station.feedback, places.feedback.word(Kind::At));
    let mut all = Vec::new();
    for (instance, setup, len, assignment) in [command, feedback] {
        let number = 2 * i as u16 + u16::from(instance) + 1;
        all.extend([
            Request::Expect(connection(instance, idn::SETUP), Value::word(setup)),
            Request::Expect(connection(instance, idn::LENGTH), Value::word((len + CONNECTION) as u16)),
            Request::Write(connection(instance, idn::NUMBER), Value::word(number)),
            Request::Write(connection(instance, idn::ASSIGNMENT), Value::word(assignment)),
            Request::Write(connection(instance, idn::PRODUCER_TIME), Value::long(timing.cycle)),
            Request::Write(connection(instance, idn::LOSSES), Value::word(timing.losses)),
        ]);
    }
    all
}

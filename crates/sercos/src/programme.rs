//! Requests of the master to a station before operation: parameters in CP2, checks before CP3 and CP4.

use crate::header::{CommunicationPhase, TelegramKind};
use crate::idn::{self, COMMAND, FEEDBACK, connection};
use crate::layout::{CONNECTION, Station, TelegramLayout};
use crate::parameters::WireValue;
use crate::service::ServiceRequest;

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
    phase: CommunicationPhase,
    timing: Timing,
    stations: &[Station],
    layout: &TelegramLayout,
    i: usize,
) -> Vec<ServiceRequest> {
    match phase {
        CommunicationPhase::Cp2 => {
            let mut all = communication(timing, &stations[i], layout, i);
            all.extend(connections(timing, &stations[i], layout, i));
            all.push(ServiceRequest::Execute(idn::CHECK_CP3));
            all
        }
        CommunicationPhase::Cp3 => vec![ServiceRequest::Execute(idn::CHECK_CP4)],
        CommunicationPhase::Cp0 | CommunicationPhase::Cp1 | CommunicationPhase::Cp4 => Vec::new(),
    }
}

fn communication(
    timing: Timing,
    station: &Station,
    layout: &TelegramLayout,
    i: usize,
) -> Vec<ServiceRequest> {
    let places = &layout.places[i];
    let lengths = |all: [usize; 4]| WireValue::words(all.map(|len| len as u16));
    vec![
        ServiceRequest::Expect(idn::ADDRESS, WireValue::word(station.address)),
        ServiceRequest::Write(idn::CYCLE_TIME, WireValue::long(timing.cycle)),
        // The ATs follow the MDTs at once: nothing waits for a time within the cycle.
        ServiceRequest::Write(idn::AT_TIME, WireValue::long(0)),
        ServiceRequest::Write(idn::BEAT_LOSSES, WireValue::word(timing.beat_losses)),
        ServiceRequest::Write(idn::CONTROL_OFFSET, WireValue::word(places.control.word(TelegramKind::Mdt))),
        ServiceRequest::Write(idn::MDT_LENGTHS, lengths(layout.mdt)),
        ServiceRequest::Write(idn::STATUS_OFFSET, WireValue::word(places.status.word(TelegramKind::At))),
        ServiceRequest::Write(idn::AT_LENGTHS, lengths(layout.at)),
        ServiceRequest::Write(
            idn::MDT_SERVICE_OFFSET,
            WireValue::word(places.mdt_service.word(TelegramKind::Mdt)),
        ),
        ServiceRequest::Write(
            idn::AT_SERVICE_OFFSET,
            WireValue::word(places.at_service.word(TelegramKind::At)),
        ),
    ]
}

fn connections(timing: Timing, station: &Station, layout: &TelegramLayout, i: usize) -> Vec<ServiceRequest> {
    let places = &layout.places[i];
    let command = (COMMAND, idn::CONSUMER, station.command, places.command.word(TelegramKind::Mdt));
    let feedback = (FEEDBACK, idn::PRODUCER, station.feedback, places.feedback.word(TelegramKind::At));
    let mut all = Vec::new();
    for (instance, setup, len, assignment) in [command, feedback] {
        let number = 2 * i as u16 + u16::from(instance) + 1;
        all.extend([
            ServiceRequest::Expect(connection(instance, idn::SETUP), WireValue::word(setup)),
            ServiceRequest::Expect(
                connection(instance, idn::LENGTH),
                WireValue::word((len + CONNECTION) as u16),
            ),
            ServiceRequest::Write(connection(instance, idn::NUMBER), WireValue::word(number)),
            ServiceRequest::Write(connection(instance, idn::ASSIGNMENT), WireValue::word(assignment)),
            ServiceRequest::Write(connection(instance, idn::PRODUCER_TIME), WireValue::long(timing.cycle)),
            ServiceRequest::Write(connection(instance, idn::LOSSES), WireValue::word(timing.losses)),
        ]);
    }
    all
}

//! Clients that watch the robot: state at a rate of their own, events, parameters; what they do not read, they lose.

use messages::Stamp;
use messages::command::Priority;

use super::{BrokerEvent, Exchange};
use crate::members::Watch;
use crate::message::{MAX_BYTES, service, service_message, write_command};
use crate::observation::layout;
use crate::refusal::Refusal;

impl Exchange<'_> {
    /// Shows a client who holds the lease, all parameters that can be changed, and the present state, and goes on with
    /// what it asked for.
    pub(super) fn watch(&mut self, token: u32, sequence: u64, rate: u16, events: bool) {
        let period = realtime::clock::SECOND.checked_div(rate.into()).unwrap_or(0);
        let Some(at) = self.members.iter().position(|m| m.sender.token == token) else { return };
        let now = self.now;
        self.show_lease(token);
        let member = &mut self.members[at];
        member.watch = Watch { asked: true, events, period, due: now + period };
        if let Some(robot) = &mut self.robot {
            for (name, value) in robot.values() {
                member.deliver(&parameter(&name, value, now));
            }
            let lost = member.lost;
            member.deliver(&service_message(service::STATE, 0, now, &robot.state(lost)));
        }
        self.answer_lines(token, sequence, layout());
    }

    /// Gives events, changed parameters and states to those who are due. Nobody is waited for.
    pub(super) fn show(&mut self) {
        let (now, Some(robot)) = (self.now, &mut self.robot) else { return };
        while let Some(event) = robot.next_event() {
            let message = service_message(service::EVENT, 0, now, &event);
            self.members.iter_mut().filter(|m| m.watch.events).for_each(|m| m.deliver(&message));
        }
        for (name, value) in robot.changed() {
            let message = parameter(&name, value, now);
            self.members.iter_mut().filter(|m| m.watch.asked).for_each(|m| m.deliver(&message));
        }
        for member in self.members.iter_mut().filter(|m| m.watch.period > 0 && now >= m.watch.due) {
            // The rate is kept on the average; what a stalled broker missed is not caught up on.
            let watch = &mut member.watch;
            watch.due = (watch.due + watch.period).max(now.saturating_sub(watch.period));
            let state = robot.state(member.lost);
            member.deliver(&service_message(service::STATE, 0, now, &state));
        }
    }

    /// The command that gives a parameter another value, as if its sender had sent that.
    pub(super) fn set_parameter(
        &mut self,
        stamp: &Stamp,
        name: &str,
        value: f64,
        report: &mut dyn FnMut(BrokerEvent),
    ) {
        let command = self.robot.as_ref().map_or_else(
            || Err(Refusal::NoParameter("nothing is known of this run's parameters".into())),
            |robot| robot.command(name, value),
        );
        let mut buffer = [0; MAX_BYTES];
        let written = command.and_then(|command| {
            let bytes = write_command(&command, Priority::Normal, stamp, &mut buffer);
            bytes.map(<[u8]>::to_vec).map_err(|e| Refusal::NotACommand(e.to_string()))
        });
        match written {
            Ok(mut bytes) => self.forward(stamp.origin, Priority::Normal as usize, &mut bytes, report),
            Err(refusal) => self.refuse(stamp.origin, stamp.sequence, u32::MAX, &refusal, report),
        }
    }

    /// Holder of the lease, sent to one client.
    pub(super) fn show_lease(&mut self, token: u32) {
        let news = self.lease_message();
        self.members.iter_mut().filter(|m| m.sender.token == token).for_each(|m| m.deliver(&news));
    }

    pub(super) fn answer_lines(&mut self, token: u32, sequence: u64, lines: Vec<String>) {
        for line in lines {
            self.answer(token, service_message(service::LINE, sequence, self.now, line.as_bytes()));
        }
        self.accept(token, sequence, "");
    }
}

fn parameter(name: &str, value: f64, now: u64) -> Vec<u8> {
    service_message(service::PARAMETER, 0, now, &[&value.to_le_bytes()[..], name.as_bytes()].concat())
}

#[cfg(test)]
#[path = "watchers_tests.rs"]
mod tests;

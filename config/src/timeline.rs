//! The commands of a scene by bus cycle: so that every process, and every repetition, sees them at the same tick.

use messages::command::Domain;
use messages::{Command, Process};

use crate::Scene;

/// Commands still to come, for one process.
#[derive(Clone, Debug)]
pub struct Timeline {
    /// (first tick at or after the command's time, command), ascending.
    entries: Vec<(u64, Command)>,
    next: usize,
    domains: &'static [Domain],
}

/// Time of reset and enable in a scene that gives none \[s\].
const ARMING: [(f64, Command); 2] = [(0.02, Command::Reset), (0.04, Command::Enable)];

impl Timeline {
    /// The scene's commands that `process` takes. A scene that never enables the motors is armed at its beginning.
    pub fn new(scene: &Scene, process: Process) -> Self {
        let domains = process.command_domains();
        // A time that is a whole number of cycles but for rounding belongs to that cycle.
        let tick = |time: f64| (time / scene.cycle - 1e-6).ceil().max(0.0) as u64;
        let armed = scene.commands.iter().any(|(_, command)| *command == Command::Enable);
        let arming = ARMING.iter().filter(|_| !armed);
        let own = arming.chain(&scene.commands).filter(|(_, command)| domains.contains(&command.address().0));
        let mut entries: Vec<_> = own.map(|(time, command)| (tick(*time), *command)).collect();
        entries.sort_by_key(|(tick, _)| *tick);
        Self { entries, next: 0, domains }
    }

    /// Drops what is still to come: of a process that was started again, which does nothing late, or because a person has taken over.
    pub fn drop_rest(&mut self) {
        self.next = self.entries.len();
    }

    /// A live command comes in between, if the process takes it: due at once, behind those that came before it.
    pub fn insert(&mut self, command: &Command) {
        if self.domains.contains(&command.address().0) {
            let waiting = self.entries[self.next..].iter().take_while(|(tick, _)| *tick == 0).count();
            self.entries.insert(self.next + waiting, (0, *command));
        }
    }

    /// The next command that is due at `tick`; to be called until there is none.
    pub fn due(&mut self, tick: u64) -> Option<Command> {
        let (at, command) = *self.entries.get(self.next)?;
        (at <= tick).then(|| {
            self.next += 1;
            command
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Setup;

    /// The last of two commands between the same cycles was taken first.
    #[test]
    fn live_commands_are_taken_in_their_order_and_before_what_the_scene_has_next() {
        let setup = Setup::load(&crate::root(None), "walk_1kmh").unwrap();
        let mut timeline = Timeline::new(&setup.scene, Process::Planner);
        let scripted = timeline.clone().due(u64::MAX);
        let live = [Command::Stop, Command::Start, Command::Stand];
        live.iter().for_each(|command| timeline.insert(command));
        timeline.insert(&Command::Reset); // another process's
        let taken: Vec<Command> = std::iter::from_fn(|| timeline.due(1)).collect();
        assert_eq!(taken, live);
        assert!(scripted.is_some());
        assert_eq!(timeline.due(u64::MAX), scripted);
    }
}

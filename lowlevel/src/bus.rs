//! Bus of a run: which field bus the joint loop uses, and the run around it.

use std::error::Error;

use config::BusAddress;
use daemon::Daemon;
use ipc::{Mode, Waiter};

use crate::can_bus::CanBus;
use crate::fieldbus::{BusSettings, Fieldbus, RunControl};
use crate::sercos_bus::SercosBus;
use crate::simulated_bus::SimulatedBus;

/// A process with what wakes it.
pub(crate) struct WaitingDaemon<'a> {
    pub(crate) daemon: &'a Daemon,
    pub(crate) waiter: &'a Waiter,
}

impl RunControl for WaitingDaemon<'_> {
    fn is_ending(&self) -> bool {
        self.daemon.stop.asked()
    }

    fn wait_for(&self, peer: &str, ready: &mut dyn FnMut() -> bool) -> Result<bool, Box<dyn Error>> {
        self.daemon.wait(self.waiter, peer, ready)
    }
}

/// Opens the bus of a run.
///
/// # Errors
/// An interface cannot be opened, or a place in shared memory is missing.
pub(crate) fn open(d: &Daemon) -> Result<Box<dyn Fieldbus>, Box<dyn Error>> {
    let settings = BusSettings {
        layout: d.setup.robot.layout.clone(),
        period_ns: d.period_ns(),
        lockstep: d.mode == Mode::Lockstep,
        patience_ns: d.patience().as_nanos() as u64,
        losses: d.setup.system.targets_missed as u16,
        simulated_robot: d.robot,
    };
    match &d.bus {
        BusAddress::Shared => Ok(Box::new(SimulatedBus::new(&d.space)?)),
        BusAddress::Can { fd, interfaces } => Ok(Box::new(CanBus::new(settings, *fd, interfaces)?)),
        BusAddress::Sercos(_) if d.setup.robot.tables.is_some() => {
            let scene = &d.setup.scene.name;
            Err(format!("scene {scene}: drives that play tables have no telegrams on Sercos; take CAN or shared memory").into())
        }
        BusAddress::Sercos(place) => Ok(Box::new(SercosBus::new(settings, place)?)),
    }
}

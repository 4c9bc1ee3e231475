//! Bus of a run: which far end the simulated robot answers at.

use std::error::Error;

use config::BusAddress;
use daemon::Daemon;

use crate::can_end::CanEnd;
use crate::far_end::FarEnd;
use crate::sercos_end::SercosEnd;
use crate::shared_end::SharedEnd;

/// Opens the far end of the bus of a run.
///
/// # Errors
/// An interface cannot be opened, or there is none for the simulated robot.
pub(crate) fn open(d: &mut Daemon) -> Result<Box<dyn FarEnd>, Box<dyn Error>> {
    match d.bus.clone() {
        BusAddress::Shared => Ok(Box::new(SharedEnd::new(d)?)),
        BusAddress::Can { fd, interfaces } => Ok(Box::new(CanEnd::new(d, fd, &interfaces)?)),
        BusAddress::Sercos(place) => Ok(Box::new(SercosEnd::new(d, &place)?)),
    }
}

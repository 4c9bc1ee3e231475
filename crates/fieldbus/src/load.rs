//! Load of a line: bits of all frames of a cycle, in the worst case of stuffing.
//!
//! Classic frames: [`codec::room`]. CAN FD (ISO 11898-1:2015): arbitration phase of 30 bits, stuffed the same way, at the nominal rate;
//! data phase of control, data, fixed stuff bits and CRC of 17 or 21 bits at the data rate.

use codec::layout::{BusMessage, FrameLayout};
pub use codec::room::BIT_RATE;
pub(crate) use codec::room::classic_bits;

/// \[bit/s\] Of the data of CAN FD there.
pub const DATA_BIT_RATE: f64 = 5e6;

/// Bit rates \[bit/s\].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rates {
    /// Of classic frames and of arbitration.
    pub nominal: f64,
    /// Of the data phase of CAN FD; none: classic CAN.
    pub data: Option<f64>,
}

/// Longest time \[s\] that a frame with `n` bytes takes.
pub(crate) fn frame_time(n: u32, rates: Rates) -> f64 {
    match rates.data {
        None => f64::from(classic_bits(n)) / rates.nominal,
        Some(data) => {
            // SOF, 11 identifier, RRS, IDE, FDF, res, BRS: 17 bits that are stuffed; ACK, EOF, intermission: 12 that are not.
            let arbitration = 17 + 17 / 4 + 12 + 1;
            let crc = if n <= 16 { 17 } else { 21 };
            // ESI, DLC and data are stuffed as they come; stuff count and CRC have a fixed stuff bit every four bits.
            let payload = 5 + 8 * n;
            let check = 4 + crc;
            let bits = payload + payload / 4 + check + check.div_ceil(4) + 1;
            f64::from(arbitration) / rates.nominal + f64::from(bits) / data
        }
    }
}

/// Longest time \[s\] that all frames of one cycle take on each line.
pub fn cycle_time(layout: &FrameLayout, rates: Rates) -> Vec<f64> {
    let on = |node: usize| layout.messages.iter().filter(move |m: &&BusMessage| m.node == node && m.cyclic);
    (0..layout.nodes.len()).map(|node| on(node).map(|m| frame_time(m.len, rates)).sum()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_frame_at_a_higher_data_rate_is_shorter() {
        let at = |data| frame_time(48, Rates { nominal: 1e6, data: Some(data) });
        assert!(at(5e6) < at(2e6) && at(5e6) < 0.2e-3, "{}", at(5e6));
    }
}

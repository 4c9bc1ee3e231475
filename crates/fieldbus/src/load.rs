//! Load of a line: bits of all frames of a cycle, in the worst case of stuffing.
//!
//! Classic frames with identifiers of 11 bits: 44 + 8n bits, up to one stuff bit after each 4 of the first 34 + 8n, and 3 bits
//! until the next frame. CAN FD (ISO 11898-1:2015): arbitration phase of 30 bits, stuffed the same way, at the nominal rate;
//! data phase of control, data, fixed stuff bits and CRC of 17 or 21 bits at the data rate.

use codec::layout::{BusMessage, FrameLayout};

/// \[bit/s\] Of arbitration, and of all of classic CAN, on the lines of these robots.
pub const BIT_RATE: f64 = 1e6;
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

/// Most bits of a classic frame with `n` bytes, until the next frame may begin.
pub(crate) fn classic_bits(n: u32) -> u32 {
    44 + 8 * n + (34 + 8 * n - 1) / 4 + 3
}

/// Longest time \[s\] that all frames of one cycle take on each line.
pub fn cycle_time(layout: &FrameLayout, rates: Rates) -> Vec<f64> {
    let on = |node: usize| layout.messages.iter().filter(move |m: &&BusMessage| m.node == node);
    (0..layout.nodes.len()).map(|node| on(node).map(|m| frame_time(m.len, rates)).sum()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Worst case of a classic frame with 8 bytes: 135 bits (Davis et al. 2007, equation 1, with 11 bits of identifier).
    #[test]
    fn published_lengths_of_classic_frames() {
        assert_eq!([0, 1, 8].map(classic_bits), [55, 65, 135]);
    }

    #[test]
    fn a_frame_at_a_higher_data_rate_is_shorter() {
        let at = |data| frame_time(48, Rates { nominal: 1e6, data: Some(data) });
        assert!(at(5e6) < at(2e6) && at(5e6) < 0.2e-3, "{}", at(5e6));
    }
}

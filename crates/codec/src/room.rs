//! Room on a line of classic CAN for what does not come in every cycle: telegrams of the drives' interpreters.
//!
//! A classic frame with an identifier of 11 bits and n bytes has 44 + 8 n bits, up to one stuff bit after each 4 of the first
//! 34 + 8 n, and 3 bits until the next frame (Davis et al. 2007).

use messages::MAX_FRAMES;

use crate::interpreter::LEN;
use crate::layout::FrameLayout;

/// \[bit/s\] Bit rate of the lines.
pub const BIT_RATE: f64 = 1e6;

/// Most bits of a classic frame with `n` bytes, until the next frame may begin.
pub const fn classic_bits(n: u32) -> u32 {
    44 + 8 * n + (34 + 8 * n - 1) / 4 + 3
}

/// \[bit\] All messages of every cycle on a line, with the worst stuffing.
pub fn cyclic_bits(layout: &FrameLayout, line: usize) -> u32 {
    let cyclic = layout.messages.iter().filter(|m| m.cyclic && m.node == line);
    cyclic.map(|m| classic_bits(m.len)).sum()
}

/// Telegrams with their answers for which a cycle \[s\] has room on each line: beside the messages of every cycle, one other
/// command to a drive and one heartbeat, and beside those of the other lines in a record.
pub fn telegrams_per_cycle(layout: &FrameLayout, cycle: f64) -> usize {
    let lines = layout.nodes.len().max(1);
    let bits = (cycle * BIT_RATE).round();
    let of_line = |line| {
        let commands = layout.messages.iter().filter(|m| m.node == line && m.to_drives && !m.cyclic);
        let command = commands.filter(|m| m.interpreter().is_none()).map(|m| classic_bits(m.len));
        let command = command.max().unwrap_or(0);
        let heartbeat = layout.messages.iter().find(|m| m.node == line && m.heartbeat().is_some());
        let heartbeat = heartbeat.map_or(0, |m| classic_bits(m.len));
        let left = bits - f64::from(cyclic_bits(layout, line) + command + heartbeat);
        (left / f64::from(2 * classic_bits(LEN))).max(0.0) as usize
    };
    // Frames of a cycle and, of each joint, one that does not come in every cycle.
    let frames = [true, false].map(|to_drives| {
        let others = layout.messages.iter().filter(|m| m.to_drives == to_drives && m.interpreter().is_none());
        MAX_FRAMES.saturating_sub(others.count()) / lines
    });
    (0..lines).map(of_line).chain(frames).min().unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Worst case of a classic frame with 8 bytes: 135 bits (Davis et al. 2007, equation 1, with 11 bits of identifier).
    #[test]
    fn published_lengths_of_classic_frames() {
        assert_eq!([0, 1, 8].map(classic_bits), [55, 65, 135]);
    }
}

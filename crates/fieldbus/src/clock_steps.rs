//! Clocks that are put back while frames are recorded: stretches of a recording between two steps of its clock.
//!
//! Within a stretch time goes forward on every interface. Interfaces are read one after the other, so their steps stand in
//! different places of a file: a frame belongs to the stretch whose newest time is nearest to its own.

/// Step of the clock between two frames of a recording.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ClockStep {
    /// Index of the first frame behind it, in [`crate::Capture::frames`].
    pub at: usize,
    /// \[ns\] Time by which this frame is earlier than the newest one before it.
    pub back_ns: u64,
}

/// Stretches so far, for frames in the order in which they were recorded.
#[derive(Clone, Debug, Default)]
pub struct ClockSteps {
    /// Newest time \[ns\] of each stretch.
    newest: Vec<u64>,
    /// Stretch and newest time \[ns\] of each interface; none before its first frame.
    lines: Vec<Option<(usize, u64)>>,
}

impl ClockSteps {
    /// Stretch of the next frame, from 0: on interface `line`, at `time_ns` \[ns\].
    pub fn stretch(&mut self, line: u32, time_ns: u64) -> usize {
        let line = line as usize;
        if line >= self.lines.len() {
            self.lines.resize(line + 1, None);
        }
        let last = self.newest.len().saturating_sub(1);
        let stretch = match self.lines[line] {
            // The clock that others have seen put back, or nobody yet.
            Some((stretch, newest)) if time_ns < newest => last.max(stretch + 1),
            Some((stretch, _)) if self.away(last, time_ns) > self.away(stretch, time_ns) => stretch,
            _ => last,
        };
        match self.newest.get_mut(stretch) {
            Some(newest) => *newest = time_ns.max(*newest),
            None => self.newest.push(time_ns),
        }
        self.lines[line] = Some((stretch, time_ns));
        stretch
    }

    /// \[ns\] Distance of a time to the newest one of a stretch.
    fn away(&self, stretch: usize, time_ns: u64) -> u64 {
        self.newest[stretch].abs_diff(time_ns)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn stretches(frames: &[(u32, u64)]) -> Vec<usize> {
        let mut clock = ClockSteps::default();
        frames.iter().map(|&(line, time)| clock.stretch(line, time)).collect()
    }

    #[test]
    fn each_step_back_of_one_interface_begins_a_stretch() {
        assert_eq!(stretches(&[(0, 10), (0, 20), (0, 20), (0, 15), (0, 16), (0, 3)]), [0, 0, 0, 1, 1, 2]);
    }

    #[test]
    fn interfaces_that_are_read_one_after_the_other_are_no_step() {
        assert_eq!(stretches(&[(0, 10), (0, 20), (1, 5), (1, 21), (0, 21)]), [0; 5]);
    }

    /// Both were put back by 500; interface 1 speaks rarely: its time never goes back.
    #[test]
    fn a_step_is_one_for_all_interfaces_and_rare_frames_belong_to_the_nearest_stretch() {
        let frames =
            [(0, 1000), (1, 1000), (0, 1400), (1, 1401), (0, 905), (1, 1402), (1, 904), (0, 1390), (2, 1391)];
        assert_eq!(stretches(&frames), [0, 0, 0, 0, 1, 0, 1, 1, 1]);
        let rare = [(1, 1000), (0, 1000), (0, 1600), (0, 1100), (0, 1495), (1, 1500)];
        assert_eq!(stretches(&rare), [0, 0, 0, 1, 1, 1]);
    }
}

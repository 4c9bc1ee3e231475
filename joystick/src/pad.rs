//! Gamepad as the kernel describes it, and what its sticks and buttons mean by a layout: pure functions of events.

use std::collections::BTreeMap;

use config::VELOCITY_STEPS;
use config::joystick::{ButtonFunction, Control, Joystick, Stick};

/// Types of the kernel's input events (`linux/input-event-codes.h`).
pub const EV_KEY: u16 = 1;
/// An axis.
pub const EV_ABS: u16 = 3;

/// Range of an axis as its driver tells it (`struct input_absinfo`); any driver's, so any numbers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct AxisRange {
    /// Least value.
    pub minimum: i32,
    /// Greatest value.
    pub maximum: i32,
    /// Values so near to the centre are the centre.
    pub flat: i32,
}

/// Values of all axes and buttons that a device has.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Pad {
    axes: BTreeMap<u16, (AxisRange, i32)>,
    buttons: BTreeMap<u16, bool>,
}

/// The operator's hands at one instant.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Hands {
    /// State of the dead-man button: true while it is held.
    pub dead_man: bool,
    /// \[1\] Forward, left, turn: shares of the gait's ranges, -1 to 1; zero within the dead zone.
    pub sticks: [f64; 3],
    /// State of each function's buttons, in the order of [`ButtonFunction::ALL`]: true while one is held.
    pub held: [bool; 6],
}

impl Pad {
    /// A device with these axes and these buttons, at rest: axes in their centre.
    pub fn new(
        axes: impl IntoIterator<Item = (u16, AxisRange)>,
        buttons: impl IntoIterator<Item = u16>,
    ) -> Self {
        let centre =
            |range: AxisRange| (i64::from(range.minimum) + i64::from(range.maximum)).div_euclid(2) as i32;
        Self {
            axes: axes.into_iter().map(|(code, range)| (code, (range, centre(range)))).collect(),
            buttons: buttons.into_iter().map(|code| (code, false)).collect(),
        }
    }

    /// Takes an event; of what the device has not, nothing.
    pub fn take(&mut self, kind: u16, code: u16, value: i32) {
        match kind {
            EV_KEY => _ = self.buttons.get_mut(&code).map(|held| *held = value != 0),
            EV_ABS => _ = self.axes.get_mut(&code).map(|(_, now)| *now = value),
            _ => {}
        }
    }

    /// True if the device has it.
    pub fn has(&self, control: &Control) -> bool {
        if control.is_axis {
            self.axes.contains_key(&control.code)
        } else {
            self.buttons.contains_key(&control.code)
        }
    }

    /// Hands by `layout`.
    pub fn hands(&self, layout: &Joystick) -> Hands {
        let held =
            ButtonFunction::ALL.map(|function| layout.button(function).iter().any(|c| self.is_held(c)));
        Hands {
            dead_man: held[ButtonFunction::DeadMan as usize],
            sticks: layout.sticks.each_ref().map(|stick| self.share(stick, layout.dead_zone)),
            held,
        }
    }

    /// True if a button is pressed, or an axis beyond the middle of its way: a trigger rests at its lower end.
    fn is_held(&self, control: &Control) -> bool {
        if !control.is_axis {
            return self.buttons.get(&control.code).copied().unwrap_or(false);
        }
        let Some((AxisRange { minimum, maximum, .. }, value)) = self.axes.get(&control.code) else {
            return false;
        };
        let [low, high, value] = [*minimum, *maximum, *value].map(i64::from);
        low < high && 2 * value > low + high
    }

    /// Share of a range that a stick commands \[1\]: zero within the dead zone of layout and driver, from there on even to its end.
    fn share(&self, stick: &Stick, dead_zone: f64) -> f64 {
        let Some((range, value)) = self.axes.get(&stick.control.code) else { return 0.0 };
        let [low, high, flat, value] = [range.minimum, range.maximum, range.flat, *value].map(f64::from);
        let half = (high - low) / 2.0;
        if half <= 0.0 {
            return 0.0;
        }
        // What a driver sends beyond its own range is its end.
        let way = ((value - (low + high) / 2.0) / half).clamp(-1.0, 1.0);
        // The centre of 256 values lies between two of them, at which many sticks rest.
        let dead = dead_zone.max((flat.max(0.0) + 0.5) / half);
        if dead >= 1.0 || way.abs() <= dead {
            return 0.0;
        }
        let share = stick.share * (way.abs() - dead) / (1.0 - dead) * way.signum();
        if stick.reverse { -share } else { share }
    }
}

/// Velocity for shares of the gait's `ranges`: forward, left \[m/s\] and turn \[rad/s\], in whole steps ([`VELOCITY_STEPS`]) towards zero.
pub fn velocity(shares: [f64; 3], ranges: &[[f64; 2]; 3]) -> [f64; 3] {
    std::array::from_fn(|i| {
        let [low, high] = ranges[i];
        let x = if shares[i] > 0.0 { shares[i] * high } else { -shares[i] * low };
        let steps = (x * VELOCITY_STEPS + 1e-6 * x.signum()).trunc();
        // Adding zero: no minus in front of it.
        if steps.is_finite() { (steps / VELOCITY_STEPS).clamp(low, high) + 0.0 } else { 0.0 }
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn layout() -> Joystick {
        Joystick::of_config(&config::root(None)).unwrap()
    }

    /// A stick of any driver.
    fn range() -> impl Strategy<Value = AxisRange> {
        let of = |(minimum, maximum, flat)| AxisRange { minimum, maximum, flat };
        prop_oneof![
            Just(AxisRange { minimum: -32768, maximum: 32767, flat: 128 }),
            Just(AxisRange { minimum: 0, maximum: 255, flat: 15 }),
            Just(AxisRange { minimum: -1, maximum: 1, flat: 0 }),
            Just(AxisRange { minimum: 0, maximum: 1023, flat: 0 }),
            (any::<i32>(), any::<i32>(), any::<i32>()).prop_map(of),
            (-3..3, -3..3, -3..3).prop_map(of),
        ]
    }

    fn gait() -> impl Strategy<Value = [[f64; 2]; 3]> {
        let one = || {
            (-200..=0i32, 0..=200i32)
                .prop_map(|(low, high)| [low, high].map(|x| f64::from(x) / VELOCITY_STEPS))
        };
        [one(), one(), one()]
    }

    /// Velocity of a pad with the value `x` on the axis of forward.
    fn forward(range: AxisRange, x: i32, layout: &Joystick, gait: &[[f64; 2]; 3]) -> f64 {
        let axis = layout.sticks[0].control.code;
        let mut pad = Pad::new([(axis, range)], []);
        pad.take(EV_ABS, axis, x);
        velocity(pad.hands(layout).sticks, gait)[0]
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 2000, ..ProptestConfig::default() })]

        /// No number of any driver leads out of the gait's range; within the dead zone it is zero; further is faster.
        #[test]
        fn velocities_are_in_range_zero_in_the_middle_and_monotonous(
            range in range(), gait in gait(), x in any::<i32>(), y in any::<i32>(), near in -2.0..2.0f64,
            dead_zone in 0.0..0.9f64, share in 0.01..1.0f64, reverse in any::<bool>(),
        ) {
            let mut layout = layout();
            layout.dead_zone = dead_zone;
            layout.sticks[0] = Stick { share, reverse, ..layout.sticks[0] };
            let AxisRange { minimum, maximum, flat } = range;
            let (low, high) = (f64::from(minimum), f64::from(maximum));
            let (centre, half) = ((low + high) / 2.0, (high - low) / 2.0);
            // Any number, and one that is near the centre.
            for value in [x, y, (centre + near * half) as i32] {
                let v = forward(range, value, &layout, &gait);
                prop_assert!(v >= share * gait[0][0] - 1e-9 && v <= share * gait[0][1] + 1e-9, "{v}");
                prop_assert!(((v * VELOCITY_STEPS).round() - v * VELOCITY_STEPS).abs() < 1e-6, "{v} is no step");
                let away = (f64::from(value) - centre).abs();
                if half <= 0.0 || away <= dead_zone * half || away <= f64::from(flat) {
                    prop_assert_eq!(v, 0.0);
                }
            }
            let (x, y) = (x.min(y), x.max(y));
            let [a, b] = [x, y].map(|value| forward(range, value, &layout, &gait));
            prop_assert!(if reverse { a >= b } else { a <= b }, "{x}: {a}, {y}: {b}");
            // The end of the stick commands its share.
            if half > 0.0 && flat < 1 && half >= 2.0 {
                let end = forward(range, if reverse { minimum } else { maximum }, &layout, &gait);
                prop_assert!((end - share * gait[0][1]).abs() < 1.01 / VELOCITY_STEPS, "{end} of {share} of {gait:?}");
            }
        }

        /// A trigger is held beyond the middle of its way, a hat and a button as they say.
        #[test]
        fn triggers_are_buttons(range in range(), x in any::<i32>()) {
            let trigger = config::joystick::CONTROLS.into_iter().find(|c| c.name == "ABS_Z").unwrap();
            let mut layout = layout();
            layout.buttons[ButtonFunction::DeadMan as usize] = vec![trigger];
            let mut pad = Pad::new([(trigger.code, range)], []);
            let AxisRange { minimum, maximum, .. } = range;
            prop_assert!(!pad.hands(&layout).dead_man, "at rest");
            pad.take(EV_ABS, trigger.code, x);
            let middle = (i64::from(minimum) + i64::from(maximum)) as f64 / 2.0;
            prop_assert_eq!(pad.hands(&layout).dead_man, minimum < maximum && f64::from(x) > middle);
        }
    }

    /// A table of a third implementation's, which the page's checks read, too: value, dead zone, share, reverse, range and velocity in
    /// steps.
    #[test]
    fn the_command_maps_as_the_page_does() {
        let text = include_str!("../../dashboard/page/checks/joystick.json");
        let rows: Vec<(i32, f64, f64, bool, f64, f64, f64)> = serde_json::from_str(text).unwrap();
        assert_eq!(rows.len(), 200);
        for (value, dead_zone, share, reverse, low, high, steps) in rows {
            let mut layout = layout();
            layout.dead_zone = dead_zone;
            layout.sticks[0] = Stick { share, reverse, ..layout.sticks[0] };
            let gait = [[low / VELOCITY_STEPS, high / VELOCITY_STEPS]; 3];
            let v = forward(AxisRange { minimum: -32768, maximum: 32767, flat: 0 }, value, &layout, &gait);
            assert!(
                (v * VELOCITY_STEPS - steps).abs() < 1e-6,
                "{value} {dead_zone} {share} {reverse}: {v} {steps}"
            );
        }
    }

    /// Shares that are no numbers command nothing.
    #[test]
    fn nan_is_zero() {
        let ranges = [[-1.0, 1.0]; 3];
        assert_eq!(velocity([f64::NAN, f64::INFINITY, f64::NEG_INFINITY], &ranges), [0.0; 3]);
        assert_eq!(
            velocity([1.0, -1.0, 0.555], &[[-0.28, 0.94], [-0.14, 0.1], [-0.49, 0.49]]),
            [0.94, -0.14, 0.27]
        );
    }

    /// Names and numbers of controls are the kernel's, as another crate has them.
    #[test]
    fn controls_are_those_of_the_kernel() {
        for control in config::joystick::CONTROLS {
            let name = if control.is_axis {
                format!("{:?}", evdev::AbsoluteAxisCode(control.code))
            } else {
                format!("{:?}", evdev::KeyCode(control.code))
            };
            let other = ["BTN_A", "BTN_B", "BTN_X", "BTN_Y", "BTN_GAMEPAD"].contains(&control.name);
            assert!(name == control.name || other, "{} is {name}", control.name);
            let parsed: Option<u16> = control.name.parse::<evdev::KeyCode>().ok().map(|key| key.0);
            assert!(control.is_axis || other || parsed == Some(control.code), "{}: {parsed:?}", control.name);
        }
    }
}

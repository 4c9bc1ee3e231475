//! Walks that turn a little: their periodic zero-moment point may be shifted along the walk at next to no cost, and is found.

use config::{Gait, Robot};
use curves::Sample;
use messages::{GaitState, LEFT, RIGHT};
use planner::footsteps::StepDemand;
use planner::origin::PlanOrigin;
use planner::planned_walk::PlannedWalk;
use planner::pose::PlanarPose;
use planner::skills::{Script, Skill};
use planner::sole::Sole;
use planner::steps::StepParameters;
use planner::verdict::PlanVerdict;
use planner::walk::Builder;
use std::f64::consts::FRAC_PI_2;

/// Uniform numbers of [0, 1), by xorshift.
struct Random(u64);

impl Random {
    fn unit(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }
}

/// Standing, about to swing the left foot, or the right one.
fn standing(gait: &Gait, left: bool) -> PlanOrigin {
    let (width, ahead) = (gait.step.width, gait.model.com_forward);
    let (stance, side) = if left { (RIGHT, width) } else { (LEFT, -width) };
    let mut feet = [PlanarPose::new(0.0, side, 0.0); 2];
    feet[stance] = PlanarPose::default();
    PlanOrigin {
        frame: PlanarPose::default(),
        height: 0.0,
        stance,
        feet,
        heights: [0.0; 2],
        body: Sample::rest([ahead, 0.5 * side, gait.model.com_height]),
        zmp: [ahead, 0.5 * side],
        torso: Sample::rest([FRAC_PI_2, FRAC_PI_2, 0.0]),
        pitch: [Sample::rest([0.0]); 2],
        toes: [Sample::rest([0.0]); 2],
        load_left: 0.5,
        previous: StepParameters { length: 0.0, side: 0.0, turn: 0.0, duration: gait.step.by_speed[0][2] },
        width,
        early: None,
        inside: None,
    }
}

/// Every small turn is walked, to both sides, and nearly all of them at once and in full.
#[test]
fn any_small_turn_is_walked() {
    let mut random = Random(0x5eed_cafe_2718_2818);
    for name in ["archie", "johnnie", "lola"] {
        let gait = Gait::load(&config::root(None).join(format!("gaits/{name}.toml"))).unwrap();
        let robot = Robot::load(&config::root(None).join(format!("robots/{name}"))).unwrap();
        let mut builder = Builder::new(&gait, robot.feet.each_ref().map(|foot| Sole::new(foot.support)));
        let mut walk = PlannedWalk::new();
        let mut sound = 0;
        for _ in 0..200 {
            // From a hundred thousandth to three hundredths of a radian in a step.
            let turn = 10f64.powf(-5.0 + 3.5 * random.unit()) * if random.unit() < 0.5 { 1.0 } else { -1.0 };
            // The foot on the side to which it turns swings first.
            let from = standing(&gait, turn > 0.0);
            let row = &gait.step.by_speed[1];
            let (length, duration) = (row[1] * (0.2 + 0.5 * random.unit()), row[2]);
            let mut verdict = |turn: f64, share: f64| {
                let wish = StepParameters { length, side: 0.0, turn, duration };
                let (state, skill, script) = (GaitState::Starting, Skill::Walk, Script::NONE);
                let demand = StepDemand { from: &from, state, wish, share, skill, script };
                builder.walk(&demand, &mut walk);
                (walk.verdict, walk.steps()[1].parameters.turn)
            };
            // The planner tries half of the change to the steps where all of it cannot be walked.
            let [whole, half] = [1.0, 0.5].map(|share| verdict(turn, share));
            let step = format!("{name}: {length} m and {turn} rad in a step");
            assert!(
                whole.0 == PlanVerdict::Sound || half.0 == PlanVerdict::Sound,
                "{step}: {whole:?}, {half:?}"
            );
            assert_eq!(whole.1, turn.clamp(-gait.step.change[2], gait.step.change[2]), "{step}");
            sound += u32::from(whole.0 == PlanVerdict::Sound);
        }
        assert!(sound >= 190, "{name}: {sound} of 200");
    }
}

//! The eight phases of a gait cycle (thesis figure 4.4) in their order, synchronous between both legs.

use messages::{GaitState, LEFT, Phase, Plan, RIGHT, Record, Step};

/// Three steps of 1 s with 0.2 s of double support; the right foot carries first.
fn walk(state: GaitState) -> Plan {
    let mut plan = Plan { state: state as u64, step_count: 3, ..Plan::empty() };
    for (k, stance) in [RIGHT, LEFT, RIGHT].into_iter().enumerate() {
        let begin = k as f64;
        plan.steps[k] =
            Step { stance: stance as u64, begin, lift: begin + 0.2, end: begin + 1.0, ..Step::default() };
    }
    plan
}

/// The phases that a foot goes through, each once.
fn sequence(plan: &Plan, foot: usize) -> Vec<Phase> {
    let mut phases: Vec<Phase> = (0..3000).map(|ms| plan.phase(foot, f64::from(ms) * 1e-3)).collect();
    phases.dedup();
    phases
}

#[test]
fn a_foot_goes_through_eight_phases() {
    use Phase::{
        InitialContact, InitialSwing, LoadingResponse, MidStance, MidSwing, PreSwing, TerminalStance,
        TerminalSwing,
    };
    let stance = [InitialContact, LoadingResponse, MidStance, TerminalStance];
    let swing = [PreSwing, InitialSwing, MidSwing, TerminalSwing];
    let plan = walk(GaitState::Walking);
    assert_eq!(sequence(&plan, RIGHT), [stance, swing, stance].concat());
    assert_eq!(sequence(&plan, LEFT), [swing, stance, swing].concat());
}

#[test]
fn legs_are_synchronous_at_initial_contact() {
    let plan = walk(GaitState::Walking);
    assert_eq!(plan.phase(LEFT, 1.0), Phase::InitialContact);
    assert_eq!(plan.phase(RIGHT, 1.0), Phase::PreSwing);
    assert_eq!(plan.phase(RIGHT, 1.0 - 1e-9), Phase::TerminalStance);
    assert!((0..3000).all(|ms| {
        let t = f64::from(ms) * 1e-3;
        !(plan.phase(LEFT, t).swings() && plan.phase(RIGHT, t).swings())
    }));
}

#[test]
fn standing_has_no_phases_and_nothing_touches_at_the_start() {
    assert_eq!(Plan::empty().phase(LEFT, 0.5), Phase::Standing);
    let plan = walk(GaitState::Starting);
    assert_eq!(plan.phase(RIGHT, 0.0), Phase::LoadingResponse);
    assert_eq!(plan.phase(RIGHT, 3.5), Phase::Standing);
}

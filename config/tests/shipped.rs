//! Every file that is shipped can be read.

use config::Robot;

#[test]
fn lola() {
    let robot = Robot::load(&config::root(None).join("robots/lola")).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(robot.joints.len(), 24);
    assert_eq!(robot.nodes.len(), 9);
    assert_eq!(robot.feet[0].points.len(), 8);
}

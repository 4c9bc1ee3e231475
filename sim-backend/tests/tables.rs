//! State counts of thesis tables 2.4 and 2.5, from the shipped robots.

use sim_backend::plant::Plant;

/// Mechanical, contact and electrical degrees of freedom, first-order equations; one row per type from 1 on.
fn holds(name: &str, table: &[[usize; 4]]) {
    let robot = config::Robot::load(&config::root(None).join("robots").join(name)).unwrap();
    println!("{name:10}{:>12}{:>9}{:>12}{:>11}", "mechanical", "contact", "electrical", "equations");
    for (depth, expected) in (1..).zip(table) {
        let plant =
            Plant::new(&robot, environment::Environment::flat(), depth, &robot.poses["stand"]).unwrap();
        let c = plant.layout().counts();
        println!("type {depth}    {:12}{:9}{:12}{:11}", c.mechanical, c.contact, c.electrical, c.odes);
        assert_eq!([c.mechanical, c.contact, c.electrical, c.odes], *expected, "{name}, type {depth}");
    }
}

#[test]
fn table_2_4() {
    let types =
        [[6, 48, 0, 60], [30, 48, 24, 132], [46, 48, 24, 164], [30, 864, 24, 948], [46, 864, 24, 980]];
    holds("lola", &types);
}

#[test]
fn table_2_5() {
    holds("johnnie", &[[6, 24, 0, 36], [21, 24, 15, 81], [26, 24, 15, 91]]);
}

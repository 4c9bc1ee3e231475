use cli::chain::Chain;
use cli::figures::Gatherer;
fn main() {
    let a: Vec<String> = std::env::args().collect();
    let root = std::path::PathBuf::from(std::env::var("CFG").unwrap_or("/tmp/cfg".into()));
    let setup = config::Setup::load(&root, &a[1]).unwrap_or_else(|e| panic!("{e}"));
    let scene = &setup.scene;
    let every: u64 = a.get(2).and_then(|s| s.parse().ok()).unwrap_or(500);
    let until: f64 = a.get(3).and_then(|s| s.parse().ok()).unwrap_or(scene.duration);
    let mut chain = Chain::new(&setup).unwrap();
    let mut g = Gatherer::default();
    let t0 = std::time::Instant::now();
    let n = (until / scene.cycle) as u64;
    let mut limited = 0;
    for i in 0..n {
        let c = chain.step();
        for e in &c.events { println!("{:.3} {:?} {:?} {}", c.sim_state.time, e.0, e.1, e.2); }
        let s = &c.controller_state;
        g.add(&c.sim_state, s);
        if i % every == 0 {
            println!("t {:.3} plan {} {:.2} g{} com_d {:.3?} com {:.3?} e {:.4?} zmpd {:.3?} zmp {:.3?} m {:.3} F {:.0?}/{:.0?} Fd {:.0?} mod {:.4?} lim {} pos {:.3?}", c.sim_state.time, s.plan_id, s.plan_time, s.gait, s.com_desired, s.com, s.inclination_error, s.zmp_desired, s.zmp, s.zmp_margin, c.sim_state.foot_wrench[0].force[2], c.sim_state.foot_wrench[1].force[2], [s.wrench_desired[0].force[2], s.wrench_desired[1].force[2]], s.modification, s.limited - limited, c.sim_state.position);
            limited = s.limited;
        }
        if c.sim_state.fallen == 1 { println!("FELL at {:.3}", c.sim_state.time); break; }
    }
    println!("{}", serde_json::to_string_pretty(&g.figures(scene, t0.elapsed().as_secs_f64(), None)).unwrap());
}

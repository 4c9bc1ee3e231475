fn main() {
    let a: Vec<String> = std::env::args().collect();
    let keep = |c: &str| !c.contains("cycle_stats") && !c.contains("events/broker") && !c.contains("events/logger");
    let x = recording::payload_hashes(a[1].as_ref(), keep).unwrap();
    let y = recording::payload_hashes(a[2].as_ref(), keep).unwrap();
    for k in x.keys().chain(y.keys()).collect::<std::collections::BTreeSet<_>>() { println!("{} {k} {:x?} {:x?}", if x.get(k)==y.get(k) {"same"} else {"DIFF"}, x.get(k), y.get(k)); }
}

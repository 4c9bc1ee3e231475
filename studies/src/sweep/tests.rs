//! Order of walks, rows on disk that survive what happens to them, tables that an independent reader reads.

use std::collections::BTreeSet;
use std::fs;
use std::path::PathBuf;

use super::*;
use columns::CellType;

/// A scene of some cycles, in whose place the tests put their directory.
const SCENE: &str = "about = \"a\"\nrobot = \"lola\"\ngait = \"lola\"\ndepth = 1\nintegrator = \"euler\"\n\
    substeps = 4\ncycle = 0.001\nstart_pose = \"stand\"\nduration = 0.02\n\
    [[push]]\ntime = 0.004\nduration = 0.01\nforce = [0.0, 60.0, 0.0]\n";
const TEXT: &str = "about = \"Pushes\"\nscenes = [\"DIR/a.toml\", \"DIR/b.toml\"]\nseeds = 3\nfirst_seed = 7\n\
    [[number]]\nkey = \"gait.control.height_p\"\nvalues = [8000, 9000]\n\
    [[number]]\nkey = \"scene.push.0.time\"\nrange = [0.001, 0.01]\n\
    [[number]]\nkey = \"scene.push.0.force.1\"\nvalues = [60, 2000]\n";

fn dir(name: &str) -> PathBuf {
    let dir = std::env::temp_dir().join(format!("gangwerk-sweep-{name}-{}", std::process::id()));
    let _ = fs::remove_dir_all(&dir);
    fs::create_dir_all(&dir).unwrap();
    dir
}

fn sweep(dir: &Path, text: &str) -> PathBuf {
    fs::write(dir.join("a.toml"), SCENE).unwrap();
    fs::write(dir.join("b.toml"), SCENE.replace("60.0", "30.0")).unwrap();
    let path = dir.join("sweep.toml");
    fs::write(&path, text.replace("DIR", &dir.display().to_string())).unwrap();
    path
}

fn given(config: &Path) -> Given<'_> {
    Given { config, progress: &|_, _, _| () }
}

#[test]
fn each_combination_has_each_seed_once_and_draws_depend_on_the_seed_alone() {
    let dir = dir("order");
    let sweep = Sweep::load(&sweep(&dir, TEXT)).unwrap();
    let cases: Vec<Case<'_>> = (0..24).map(|walk| Case::of(&sweep, walk)).collect();
    let key = |c: &Case<'_>| format!("{} {} {} {}", c.scene, c.values[0], c.values[2], c.seed);
    assert_eq!(cases.iter().map(key).collect::<BTreeSet<_>>().len(), 24);
    for case in &cases {
        assert!((7..10).contains(&case.seed) && (0.001..0.01).contains(&case.values[1]));
        assert_eq!(case.values[1], cases[(case.seed - 7) as usize].values[1], "{case:?}");
    }
    assert_ne!(cases[0].values[1], cases[1].values[1]);
    assert_ne!(cases[0].scene, cases[23].scene);
}

/// On one core, on three, in pieces, and killed after any byte: the same table.
#[test]
fn who_walked_what_does_not_matter() {
    let (dir, config) = (dir("bytes"), config::root(None));
    let order = SweepOrder::load(&config, &sweep(&dir, TEXT), "program").unwrap();
    let table = |name: &str| fs::read(dir.join(name).join("table.parquet")).unwrap();
    run(&order, &dir.join("one"), 1, &given(&config)).unwrap();
    run(&order, &dir.join("three"), 3, &given(&config)).unwrap();
    // As workers would send them.
    let mut lines = Vec::new();
    for walks in [20..24, 0..20] {
        piece(&order, walks, order.identity(), &mut lines).unwrap();
    }
    collect(&order, &dir.join("told"), (&mut lines.as_slice(), &mut Vec::new()), &given(&config)).unwrap();
    let whole = fs::read(dir.join("one").join(rows::NAME)).unwrap();
    // As a kill leaves them.
    let mut random = crate::random::Random(20261128);
    for k in 0..12 {
        let name = format!("cut{k}");
        fs::create_dir_all(dir.join(&name)).unwrap();
        let end = random.within([0.0, whole.len() as f64]) as usize;
        fs::write(dir.join(&name).join(rows::NAME), &whole[..end]).unwrap();
        run(&order, &dir.join(&name), 2, &given(&config)).unwrap();
        assert_eq!(table(&name), table("one"), "cut after {end} bytes");
        let rows = fs::read_to_string(dir.join(&name).join(rows::NAME)).unwrap();
        assert!(rows.ends_with('\n') && rows.lines().count() == 26, "cut after {end} bytes: {rows}");
    }
    assert_eq!(table("three"), table("one"));
    assert_eq!(table("told"), table("one"));
}

/// What a sweep has begun with holds to its end, and who edits a scene meanwhile changes nothing.
#[test]
fn files_that_go_away_meanwhile_are_not_missed() {
    let (dir, config) = (dir("away"), config::root(None));
    let order = SweepOrder::load(&config, &sweep(&dir, TEXT), "program").unwrap();
    run(&order, &dir.join("before"), 1, &given(&config)).unwrap();
    fs::remove_file(dir.join("a.toml")).unwrap();
    fs::write(dir.join("b.toml"), SCENE.replace("60.0", "90.0")).unwrap();
    run(&order, &dir.join("after"), 1, &given(&config)).unwrap();
    let table = |name: &str| fs::read(dir.join(name).join("table.parquet")).unwrap();
    assert_eq!(table("before"), table("after"));
}

#[test]
fn rows_of_something_else_are_refused_and_stay() {
    let (dir, config) = (dir("else"), config::root(None));
    let order = SweepOrder::load(&config, &sweep(&dir, TEXT), "program").unwrap();
    let out = dir.join("out");
    run(&order, &out, 1, &given(&config)).unwrap();
    let rows = fs::read_to_string(out.join(rows::NAME)).unwrap();
    let refused = |order: &SweepOrder| run(order, &out, 1, &given(&config)).unwrap_err().to_string();

    let other = SweepOrder::load(&config, &dir.join("sweep.toml"), "another program").unwrap();
    assert!(refused(&other).contains("holds rows of `# program, sweep"), "{}", refused(&other));
    let why = piece(&other, 0..1, order.identity(), &mut Vec::new()).unwrap_err().to_string();
    assert!(why.starts_with("this is `another program, ") && why.contains("begun by `program, "), "{why}");
    let other = sweep(&dir, &TEXT.replace("9000", "9001"));
    let other = SweepOrder::load(&config, &other, "program").unwrap();
    assert!(refused(&other).contains("choose another place with --out"));
    assert_eq!(fs::read_to_string(out.join(rows::NAME)).unwrap(), rows);

    // A walk that comes out in two ways, one that there is not, and half a line in the middle.
    let line = rows.lines().nth(2).unwrap();
    let mut open = open(&order, &out).unwrap();
    assert_eq!(open.add(line), Ok(false), "the same again");
    assert!(
        open.add(&line.replacen("false", "true", 1).replacen("0.0", "0.1", 1))
            .unwrap_err()
            .contains("two ways")
    );
    let (_, rest) = line.split_once('\t').unwrap();
    assert!(open.add(&format!("24\t{rest}")).unwrap_err().contains("is no walk of this sweep, which has 24"));
    assert!(open.add("1\tpush").unwrap_err().contains("does not have the columns"));
    let twice = run(&order, &out, 1, &given(&config)).unwrap_err().to_string();
    assert!(twice.contains("another `gangwerk sweep` writes there"), "{twice}");
    drop(open);
    fs::write(out.join(rows::NAME), rows.replacen('\t', " ", 40)).unwrap();
    assert!(refused(&order).contains("rows.tsv: line 2: holds rows of"));
}

/// Regression: a file of somebody else was emptied if it had no whole line.
#[test]
fn a_file_without_a_whole_line_is_cut_only_if_it_begins_like_rows() {
    let (dir, config) = (dir("foreign"), config::root(None));
    let order = SweepOrder::load(&config, &sweep(&dir, TEXT), "program").unwrap();
    let path = dir.join(rows::NAME);
    let head = format!("# {}\nwalk\tscene", order.identity());
    let other = head.replace("walk", "run");
    for (begins, of_a_sweep) in
        [("", true), (&head[..9], true), (&head[..], true), ("my notes", false), (&other[..], false)]
    {
        fs::write(&path, begins).unwrap();
        let opened = open(&order, &dir).map(|_| ());
        assert_eq!(opened.is_ok(), of_a_sweep, "{begins}: {opened:?}");
        if let Err(why) = opened {
            assert!(why.contains("choose another place with --out"), "{why}");
            assert_eq!(fs::read_to_string(&path).unwrap(), begins);
        }
    }
}

/// Regression: a last row that was cut inside of a number was taken with that number.
#[test]
fn a_last_row_without_its_end_is_missing() {
    let (dir, config) = (dir("end"), config::root(None));
    let order = SweepOrder::load(&config, &sweep(&dir, TEXT), "program").unwrap();
    let mut lines = Vec::new();
    piece(&order, 0..24, order.identity(), &mut lines).unwrap();
    for cut in [1, 4] {
        let (out, mut given_lines) = (dir.join(cut.to_string()), &lines[..lines.len() - cut]);
        let done = collect(&order, &out, (&mut given_lines, &mut Vec::new()), &given(&config));
        let why = done.map(|_| ()).unwrap_err().to_string();
        assert!(why.starts_with("1 of 24 walks are missing"), "{why}");
    }
}

/// Regression: walks counted as survived of which the simulation itself says that they are not to be trusted.
#[test]
fn a_walk_that_is_not_to_be_trusted_is_not_survived() {
    let (dir, config) = (dir("doubts"), config::root(None));
    // Two steps in a cycle are too few for the feet of type 3.
    let text =
        "about = \"a\"\nscenes = [\"DIR/c.toml\"]\n[[number]]\nkey = \"scene.substeps\"\nvalues = [2, 10]\n";
    let scene = SCENE.replace("depth = 1", "depth = 3\nforce_step = true").replace("euler", "semi_implicit");
    fs::write(dir.join("c.toml"), scene.replace("0.02", "0.1")).unwrap();
    let order = SweepOrder::load(&config, &sweep(&dir, text), "program").unwrap();
    let sheet = run(&order, &dir.join("out"), 1, &given(&config)).unwrap().json();
    let (row, rows) = (&sheet["rows"][0], fs::read_to_string(dir.join("out").join(rows::NAME)).unwrap());
    assert_eq!((&row["survived"], &row["how"]["not to be trusted"]), (&1.into(), &1.into()), "{row}");
    let rows: Vec<Vec<&str>> = rows.lines().skip(1).map(|line| line.split('\t').collect()).collect();
    assert_eq!(rows[0][4..7], ["survived", "ended_by", "doubts"]);
    assert!(rows[1][4..6] == ["false", "done"] && rows[1][6].contains("too long"), "{rows:?}");
    assert_eq!(rows[2][4..7], ["true", "done", ""]);
}

#[test]
fn missing_rows_are_counted() {
    let (dir, config) = (dir("missing"), config::root(None));
    let order = SweepOrder::load(&config, &sweep(&dir, TEXT), "program").unwrap();
    let (mut lines, mut told) = (Vec::new(), Vec::new());
    piece(&order, 3..5, order.identity(), &mut lines).unwrap();
    let collect = |lines: &[u8], told: &mut Vec<u8>| {
        collect(&order, &dir.join("out"), (&mut &lines[..], told), &given(&config)).map(|_| ())
    };
    let why = collect(&lines, &mut told).unwrap_err().to_string();
    assert!(why.starts_with("22 of 24 walks are missing; start the sweep again"), "{why}");
    told.clear();
    assert!(collect(&[], &mut told).is_err());
    let told: serde_json::Value = serde_json::from_slice(&told).unwrap();
    assert_eq!(told["left"].as_array().unwrap().len(), 22);
    assert_eq!(told["identity"], order.identity());
    assert!(piece(&order, 20..25, order.identity(), &mut Vec::new()).is_err());
}

#[test]
fn what_is_wrong_is_refused_before_anything_is_walked() {
    let (dir, config) = (dir("wrong"), config::root(None));
    let head = "about = \"a\"\nscenes = [\"DIR/a.toml\"]\n";
    let number = |key: &str, value: &str| format!("{head}[[number]]\nkey = \"{key}\"\n{value}\n");
    for (text, why) in [
        (number("scene.push.0.time", "values = [0.01, -1.0]"), "a.toml, scene.push.0.time = -1: "),
        (number("gait.control.height_p", "range = [1.0, 1e12]"), "gait.control.height_p = 1000000000000: "),
        (number("scene.push.1.time", "values = [1.0]"), "push.1.time: `1` is no component; there are 1"),
        (number("scene.pusch.0.time", "values = [1.0]"), "pusch.0.time: there is no `pusch`"),
        (format!("{head}[survived]\ndistance = [0.0, 1.0]\n"), "the nearest is `distance_m`"),
        (format!("{head}[map]\nacross = \"scene.a\"\nup = \"scene.b\"\n"), "`scene.a` is not the key of a"),
        (head.replace("a.toml", "c.toml"), "c.toml"),
        (head.replace("]", ", \"DIR/./a.toml\"]"), "a.toml` are the same file"),
        (number("scene.push.0.force.+1", "values = [1.0]"), "`+1` is no component; there are 3"),
        (number("scene.push.0.force.1", "values = [60, 60.0]"), "60 is there twice"),
    ] {
        let error = SweepOrder::load(&config, &sweep(&dir, &text), "program").map(|_| ()).unwrap_err();
        assert!(error.to_string().contains(why), "{error}, not {why}");
    }
}

/// Values that are allowed one by one, and not together, are rows: a sweep that runs for a night does not end at one of them.
#[test]
fn values_that_do_not_go_together_are_told_in_their_rows() {
    let (dir, config) = (dir("together"), config::root(None));
    let text = "about = \"a\"\nscenes = [\"DIR/a.toml\"]\n[[number]]\nkey = \"scene.duration\"\nvalues = [0.02, 0.005]\n\
                [[number]]\nkey = \"scene.push.0.time\"\nvalues = [0.002, 0.01]\n";
    let order = SweepOrder::load(&config, &sweep(&dir, text), "program").unwrap();
    run(&order, &dir.join("out"), 1, &given(&config)).unwrap();
    let rows = fs::read_to_string(dir.join("out").join(rows::NAME)).unwrap();
    let ends: Vec<&str> = rows.lines().skip(2).map(|line| line.split('\t').nth(6).unwrap()).collect();
    assert!(ends[3].starts_with("refused: ") && ends[3].contains("after the end"), "{ends:?}");
    assert!(ends[..3].iter().all(|end| *end == "done"), "{ends:?}");
}

/// Any number comes back with its bits, whatever it is.
#[test]
fn a_line_gives_back_its_row() {
    let columns =
        [("walk", CellType::Whole), ("a", CellType::Number), ("b", CellType::Text), ("c", CellType::YesNo)];
    let columns = columns.map(|(name, of)| (name.to_owned(), of));
    let mut random = crate::random::Random(3);
    for walk in 0..1000 {
        let x = f64::from_bits((random.unit() * u64::MAX as f64) as u64);
        let row = vec![
            Cell::Whole(walk),
            Cell::Number(Some(x).filter(|x| x.is_finite())),
            Cell::Text("fell".into()),
            Cell::YesNo(walk % 2 == 0),
        ];
        assert_eq!(columns::row(&columns::line(&row), &columns), Some(row));
    }
    for bad in ["", "1\tinf\tfell\ttrue", "1\t\tfell\tmaybe", "-1\t\tfell\ttrue", "1\t\tfell"] {
        assert_eq!(columns::row(bad, &columns), None, "{bad}");
    }
}

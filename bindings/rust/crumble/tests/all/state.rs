use crate::{at_depth, brittle_cube, error, press, pressed_cube};
use crumble::*;

/// A file that nobody else writes; gone with the value.
struct File(std::path::PathBuf);

impl File {
    fn new(name: &str) -> Self {
        Self(std::env::temp_dir().join(format!("crumble-{}-{name}", std::process::id())))
    }

    fn path(&self) -> &str {
        self.0.to_str().unwrap()
    }
}

impl Drop for File {
    fn drop(&mut self) {
        let _ = std::fs::remove_file(&self.0);
    }
}

#[test]
fn a_restored_snapshot_goes_on_with_the_same_bits() {
    let mut sim = pressed_cube();
    press(&mut sim, 300);
    let (snapshot, hash) = (sim.snapshot().unwrap(), sim.state_hash().unwrap());
    press(&mut sim, 200);
    let later = sim.state_hash().unwrap();
    assert_ne!(later, hash);

    let mut other = pressed_cube();
    other.restore(&snapshot).unwrap();
    assert_eq!(other.state_hash().unwrap(), hash);
    press(&mut other, 200);
    assert_eq!(other.state_hash().unwrap(), later);
    assert_eq!(error(other.restore(&snapshot[..100])).code(), Code::CORRUPT);
}

#[test]
fn a_recording_verifies() {
    let file = File::new("press.rec");
    let mut sim = pressed_cube();
    assert_eq!(error(sim.save_recording(file.path())).code(), Code::STATE);
    sim.begin_recording().unwrap();
    press(&mut sim, 50);
    sim.save_recording(file.path()).unwrap();
    sim.end_recording().unwrap();
    assert_eq!(verify_recording(file.path()).unwrap(), (50, 50));
    std::fs::write(file.path(), "no recording").unwrap();
    assert_eq!(error(verify_recording(file.path())).code(), Code::FORMAT);
}

#[test]
fn a_recording_is_looked_at_step_by_step() {
    let file = File::new("steps.rec");
    let mut sim = pressed_cube();
    press(&mut sim, 10);
    sim.begin_recording().unwrap();
    let start = sim.state_hash().unwrap();
    press(&mut sim, 30);
    sim.configure(&SimDef { stiffness: 60.0, ..sim.def().unwrap() }).unwrap(); // a recording keeps changes
    let changed = press(&mut sim, 40);
    sim.save_recording(file.path()).unwrap();

    let recording = Recording::load(file.path()).unwrap();
    let info = recording.info().unwrap();
    assert_eq!((info.step_count, info.first_step, info.tool_count), (70, 10, 1));
    let mut again = recording.create_sim().unwrap();
    assert_eq!(again.state_hash().unwrap(), start);
    assert!((0..70).all(|step| recording.step(&mut again, step).unwrap()));
    assert_eq!(again.state_hash().unwrap(), sim.state_hash().unwrap());
    assert!(changed > 0.0 && !again.contacts().unwrap().is_empty());
    assert_eq!(error(recording.step(&mut again, 70)).code(), Code::OUT_OF_RANGE);
    assert!(!recording.step(&mut again, 0).unwrap()); // not where it was recorded

    drop(recording);
    again.step(&at_depth(0.0)).unwrap(); // the simulation is there without it
    let mut reader = Reader::create(&again, &ReaderDef::default()).unwrap();
    reader.update().unwrap();
    let triangles = crate::cube().info().unwrap().boundary_triangle_count as usize;
    assert!(!reader.spread_over_skin(&vec![[0.5; 6]; triangles]).unwrap().is_empty());
    assert_eq!(error(Recording::load("there is no such file")).code(), Code::IO);
}

#[test]
fn the_surface_is_closed() {
    let mut sim = pressed_cube();
    assert_eq!(error(sim.view(array::SURFACE_POSITIONS)).code(), Code::STATE);
    press(&mut sim, 1000);
    let info = sim.extract_surface().unwrap();
    assert!(info.triangle_count > info.skin_triangle_count);
    let triangles = sim.view(array::SURFACE_TRIANGLES).unwrap();
    assert_eq!(triangles.len(), info.triangle_count as usize);
    assert_eq!(sim.view(array::SURFACE_NORMALS).unwrap().len(), triangles.len());
    assert_eq!(sim.view(array::SURFACE_POSITIONS).unwrap().len(), info.vertex_count as usize);
    let mut edges = std::collections::HashMap::new();
    for t in triangles {
        for k in 0..3 {
            *edges.entry((t[k], t[(k + 1) % 3])).or_insert(0) += 1;
        }
    }
    assert!(edges.iter().all(|((a, b), n)| edges.get(&(*b, *a)) == Some(n)));
}

#[test]
fn fragments_sleep_and_go() {
    let mut sim = brittle_cube();
    assert_eq!(sim.count_fragments().unwrap(), 1);
    press(&mut sim, 1400);
    let count = sim.count_fragments().unwrap();
    assert!(count > 1, "nothing came off");
    let ids = sim.view(array::NODE_FRAGMENTS).unwrap();
    assert_eq!(*ids.iter().max().unwrap(), count - 1);
    sim.set_fragment_state(count - 1, FragmentState::ASLEEP).unwrap();
    assert_eq!(sim.fragment_state(count - 1).unwrap(), FragmentState::ASLEEP);
    for fragment in sim.find_debris(1000, 1e9).unwrap() {
        sim.set_fragment_state(fragment, FragmentState::REMOVED).unwrap();
    }
    assert!(sim.counters().unwrap().removed > 0);
    assert!(sim.view(array::NODE_FRAGMENTS).unwrap().contains(&NONE));
    assert_eq!(error(sim.set_fragment_state(count, FragmentState::ASLEEP)).code(), Code::OUT_OF_RANGE);
}

use crate::{brittle_cube, cube, error, press, pressed_cube};
use crumble::*;

#[test]
fn a_reader_follows_on_another_thread() {
    let mut sim = pressed_cube();
    let mut reader = Reader::create(&sim, &ReaderDef::default()).unwrap();
    assert_eq!(error(sim.add_tool(&ToolDef::default())).code(), Code::IN_USE);
    let drawing = std::thread::spawn(move || {
        let mut last = 0;
        for _ in 0..10_000 {
            let info = reader.update().unwrap();
            assert!(info.step >= last);
            last = info.step;
            if last >= 400 {
                break;
            }
            std::thread::sleep(std::time::Duration::from_millis(1));
        }
        (last, reader)
    });
    press(&mut sim, 500);
    sim.publish().unwrap();
    let (last, mut reader) = drawing.join().unwrap();
    assert!(last >= 400);
    sim.publish().unwrap();
    drop(sim); // the reader keeps the last state
    let info = reader.update().unwrap();
    assert_eq!(reader.view(array::SURFACE_TRIANGLES).unwrap().len(), info.triangle_count as usize);
    assert_eq!(reader.copy(array::POSITIONS).unwrap().len(), reader.view(array::POSITIONS_X).unwrap().len());
}

#[test]
fn events_tell_of_touch_and_cuts() {
    let mut sim = brittle_cube();
    let mut reader = Reader::create(&sim, &ReaderDef::default()).unwrap();
    press(&mut sim, 1400);
    let events = reader.read_events(16384).unwrap();
    let of = |kind| events.iter().filter(|e| e.kind == kind).count() as u64;
    assert_eq!(of(EventKind::CUT), sim.counters().unwrap().cuts);
    assert!(of(EventKind::CONTACT_BEGIN) > 0);
    assert_eq!(of(EventKind::SPLIT), u64::from(sim.count_fragments().unwrap()) - 1);
    let cut = events.iter().find(|e| e.kind == EventKind::CUT).unwrap();
    assert!(cut.spring != NONE && cut.holder == NONE && cut.energy > 0.0);
    assert_eq!(reader.read_events(16).unwrap(), []);
}

#[test]
fn fragments_share_the_bodys_mass() {
    let mut sim = brittle_cube();
    let mut reader = Reader::create(&sim, &ReaderDef::default()).unwrap();
    press(&mut sim, 1400);
    sim.publish().unwrap();
    let info = reader.update().unwrap();
    let fragments: Vec<FragmentInfo> = (0..info.fragment_count).map(|f| reader.fragment(f).unwrap()).collect();
    let mass: f64 = fragments.iter().map(|f| f.mass).sum();
    assert!(fragments.len() > 1 && (mass - sim.def().unwrap().mass).abs() < 1e-12);
    assert_eq!((fragments[0].parent, fragments[0].state), (NONE, FragmentState::ACTIVE));
    let nodes: usize = (0..info.fragment_count).map(|f| reader.fragment_list(f, List::NODES).unwrap().len()).sum();
    assert_eq!(nodes, reader.view(array::NODE_FRAGMENTS).unwrap().len());
    assert_eq!(error(reader.fragment(info.fragment_count)).code(), Code::OUT_OF_RANGE);
}

#[test]
fn texture_coordinates_spread_over_the_skin() {
    let mesh = cube();
    let sim = Simulation::create(&mesh, &SimDef::default()).unwrap();
    let mut reader = Reader::create(&sim, &ReaderDef::default()).unwrap();
    reader.update().unwrap();
    let boundary = vec![[0.25f32; 6]; mesh.info().unwrap().boundary_triangle_count as usize];
    let skin = reader.spread_over_skin(&boundary).unwrap();
    assert!(!skin.is_empty() && skin.iter().flatten().all(|&u| (u - 0.25).abs() < 1e-6));
    assert_eq!(error(reader.spread_over_skin(&boundary[1..])).code(), Code::OUT_OF_RANGE);
}

use crate::{cube, error, pressed_cube};
use crumble::*;

#[test]
fn an_error_has_code_name_and_the_librarys_text() {
    let def = SimDef { stiffness: -1.0, ..SimDef::default() };
    let refused = error(Simulation::create(&cube(), &def));
    assert_eq!(refused.code(), Code::OUT_OF_RANGE);
    assert_eq!(refused.name(), "CRUMBLE_E_OUT_OF_RANGE");
    assert!(refused.text().starts_with("crumble_sim_create: ") && refused.text().contains("stiffness"), "{refused}");
    assert!(refused.text().contains("stiffness must"), "{refused}");
    let slow = error(Simulation::create(&cube(), &SimDef { tau: 10.0, ..SimDef::default() }));
    assert!(slow.text().contains("tau must not exceed"), "{slow}");
    assert_eq!(refused.to_string(), format!("CRUMBLE_E_OUT_OF_RANGE: {}", refused.text()));
    assert_eq!(format!("{:?} {:?}", refused.code(), Code(77)), "Code::OUT_OF_RANGE Code(77)");
}

#[test]
fn a_bad_pose_is_refused_and_counted() {
    let mut sim = pressed_cube();
    let hash = sim.state_hash().unwrap();
    let pose = Pose { orientation: [1.0, 1.0, 0.0, 0.0], ..Pose::default() };
    assert_eq!(error(sim.step(&pose)).code(), Code::BAD_POSE);
    assert_eq!(sim.counters().unwrap().bad_poses, 1);
    assert_eq!(sim.step_info().unwrap().status, Code::BAD_POSE.0);
    assert_eq!(sim.state_hash().unwrap(), hash);
}

#[test]
fn what_does_not_fit_c_is_refused_here() {
    let mut sim = pressed_cube();
    let zero = error(sim.save_recording("a\0b"));
    assert_eq!((zero.code(), zero.text()), (Code::INVALID_VALUE, "path holds a zero byte"));
    let def = SimDef { kernel: Some("\0".to_string()), ..SimDef::default() };
    assert!(error(sim.configure(&def)).text().contains("kernel"));
    let mut wrenches = [Wrench { force: [1.0; 3], torque: [1.0; 3] }; 2];
    assert_eq!(error(sim.step_tools(&[Pose::default()], &mut wrenches)).code(), Code::OUT_OF_RANGE);
    assert_eq!(wrenches, [Wrench::default(); 2]);
}

#[test]
fn a_kernel_that_is_not_there_is_told_with_those_that_are() {
    let def = SimDef { kernel: Some("steam".to_string()), ..SimDef::default() };
    let refused = error(Simulation::create(&cube(), &def));
    assert_eq!(refused.code(), Code::UNSUPPORTED);
    assert!(refused.text().contains("steam") && refused.text().contains("scalar"), "{refused}");
}

#[test]
fn versions_are_compared() {
    assert_eq!(version(), crumble_sys::CRUMBLE_VERSION_NUMBER);
    assert_eq!(version_string(), env!("CARGO_PKG_VERSION"));
    assert!(build_info().contains(version_string()));
    assert_eq!(error(check_version(version() + 1_000_000)).code(), Code::VERSION);
}

#[test]
fn every_kernel_gives_the_same_bits() {
    let hashes: Vec<u64> = kernel_names()
        .map(|kernel| {
            let def = SimDef { kernel: Some(kernel.to_string()), ..SimDef::default() };
            let mut sim = Simulation::create(&cube(), &def).unwrap();
            assert_eq!(sim.def().unwrap().kernel.as_deref(), Some(kernel));
            sim.add_tool(&ToolDef::default()).unwrap();
            crate::press(&mut sim, 50);
            sim.state_hash().unwrap()
        })
        .collect();
    assert!(!hashes.is_empty() && hashes.iter().all(|&hash| hash == hashes[0]), "{hashes:x?}");
}

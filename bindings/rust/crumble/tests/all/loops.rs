use crate::{error, pressed_cube};
use crumble::*;
use std::time::Duration;

/// A hand that goes 8 mm down, as examples/c/feel_tofu.c has it, on the smaller cube.
fn hand() -> (HandDef, Device) {
    let points = vec![
        MotionPoint { time: 0.8, ..MotionPoint::default() },
        MotionPoint { time: 1.8, move_: [0.0, -0.008, 0.0], ..MotionPoint::default() },
    ];
    let mut def = DeviceDef { kind: DeviceKind::HAND, points, ..DeviceDef::default() };
    def.start.position[1] = 0.003;
    let mut hand = HandDef::default();
    hand.workspace.position[1] = 0.024;
    (hand, Device::open(&def).unwrap())
}

fn host_driven() -> LoopDef {
    LoopDef { driver: Driver::HOST, ..LoopDef::default() }
}

#[test]
fn a_host_ticks_and_the_hand_feels_the_body() {
    let (mut sim, (hand, mut device)) = (pressed_cube(), hand());
    let mut feel = Loop::create(&mut sim, &host_driven(), vec![(hand, &mut device)]).unwrap();
    let mut most = 0.0f64;
    for _ in 0..2000 {
        feel.tick().unwrap();
        most = most.max(feel.hand(0).unwrap().force[1]);
    }
    assert!(most > 0.05, "{most}");
    let status = feel.status().unwrap();
    assert_eq!((status.ticks, status.steps, status.hand_count), (2000, 2000, 1));
    assert_eq!(feel.hand(0).unwrap().state, HandState::RUNNING);
    assert_eq!(feel.times().unwrap().tick_wall.count, 2000);
    let lowest = feel.sim().view(array::POSITIONS_Y).unwrap().iter().copied().fold(1.0, f64::min);
    assert!(lowest > -0.01);
    assert_eq!(feel.sim().step_info().unwrap().step, 2000);
    assert_eq!(feel.device(0).unwrap().info().unwrap().kind, DeviceKind::HAND);
    assert!(feel.device(1).is_none());
    drop(feel);
    sim.step(&Pose::default()).unwrap(); // the simulation is free again
    device.read().unwrap();
}

#[test]
fn a_loop_of_its_own_thread_is_watched_from_others() {
    let (mut sim, (hand, mut device)) = (pressed_cube(), hand());
    let def = LoopDef { driver: Driver::OWN_THREAD, priority: 0, ..LoopDef::default() };
    let mut feel = Loop::create(&mut sim, &def, vec![(hand, &mut device)]).unwrap();
    let monitor = feel.monitor();
    assert!(!monitor.is_running().unwrap());
    feel.start().unwrap();
    let watching = std::thread::spawn({
        let monitor = monitor.clone();
        move || {
            while monitor.status().unwrap().ticks < 20 {
                std::thread::sleep(Duration::from_millis(1));
            }
            monitor.halt().unwrap();
            while monitor.hand(0).unwrap().fault != Fault::HALTED {
                std::thread::sleep(Duration::from_millis(1));
            }
            monitor.reset_fault(0).unwrap();
        }
    });
    watching.join().unwrap();
    assert!(monitor.is_running().unwrap());
    assert_eq!(error(feel.sim().state_hash()).code(), Code::BUSY);
    assert_eq!(error(feel.start()).code(), Code::STATE);
    assert!(!feel.scheduling().unwrap().contains('\0'));
    feel.stop().unwrap();
    feel.sim().state_hash().unwrap();
    drop(feel);
    let gone = error(monitor.status());
    assert_eq!(gone.code(), Code::STALE_HANDLE);
    assert!(gone.text().contains("crumble_loop_get_status"), "{gone}");
}

#[test]
fn a_loop_that_runs_changes_its_simulation() {
    let (mut sim, (hand, mut device)) = (pressed_cube(), hand());
    let def = sim.def().unwrap();
    let running = LoopDef { driver: Driver::OWN_THREAD, priority: 0, ..LoopDef::default() };
    let mut feel = Loop::create(&mut sim, &running, vec![(hand, &mut device)]).unwrap();
    feel.start().unwrap();
    let monitor = feel.monitor();
    std::thread::spawn(move || {
        monitor.configure(&SimDef { stiffness: 60.0, ..def.clone() }).unwrap();
        monitor.set_tool(0, &ToolDef { radius: 0.003, ..ToolDef::default() }).unwrap();
        monitor.set_friction(0, 0.3, 0.2).unwrap();
        let refused = error(monitor.configure(&SimDef { tau: 0.01, ..def }));
        assert!(
            refused.code() == Code::STATE && refused.text().contains("tau is 0.001 and cannot become"),
            "{refused}"
        );
        assert_eq!(error(monitor.set_tool(1, &ToolDef::default())).code(), Code::OUT_OF_RANGE);
        let seen = monitor.status().unwrap().ticks;
        while monitor.status().unwrap().ticks < seen + 20 {
            std::thread::sleep(Duration::from_millis(1));
        }
    })
    .join()
    .unwrap();
    feel.stop().unwrap();
    assert_eq!(feel.sim().def().unwrap().stiffness, 60.0);
}

#[test]
fn nobody_changes_a_simulation_that_is_looked_at() {
    let (mut sim, (hand, mut device)) = (pressed_cube(), hand());
    let mut feel = Loop::create(&mut sim, &host_driven(), vec![(hand, &mut device)]).unwrap();
    feel.tick().unwrap();
    let (monitor, def) = (feel.monitor(), SimDef { stiffness: 60.0, ..feel.sim().def().unwrap() });
    let look = feel.sim();
    let heights = look.view(array::POSITIONS_Y).unwrap();
    for refused in [monitor.configure(&def), monitor.set_friction(0, 0.1, 0.1), feel.set_tool(0, &ToolDef::default())] {
        assert_eq!(error(refused).code(), Code::BUSY);
    }
    assert!(heights.iter().all(|y| y.is_finite()));
    drop(look);
    monitor.configure(&def).unwrap(); // at once: the loop does not run
    assert_eq!(feel.sim().def().unwrap().stiffness, 60.0);
    drop(feel);
    assert_eq!(error(monitor.configure(&def)).code(), Code::STALE_HANDLE);
}

#[test]
fn warnings_and_faults_have_words() {
    let (mut sim, (hand, mut device)) = (pressed_cube(), hand());
    let feel = Loop::create(&mut sim, &host_driven(), vec![(hand, &mut device)]).unwrap();
    let count = feel.status().unwrap().warning_count;
    assert!((0..count).all(|w| !feel.warning(w).unwrap().is_empty()));
    assert_eq!(error(feel.warning(count)).code(), Code::OUT_OF_RANGE);
    assert_eq!((Fault::HALTED.name(), Fault(1000).name()), ("halted", "unknown"));
    assert!(Fault::SPEED.reason().len() > Fault::SPEED.name().len());
}

#[test]
fn a_loop_that_cannot_be_leaves_its_parts() {
    let (mut sim, (hand, mut device)) = (pressed_cube(), hand());
    let wrong = HandDef { tool: 5, ..hand };
    let refused = error(Loop::create(&mut sim, &host_driven(), vec![(wrong, &mut device)]));
    assert!(refused.code() == Code::OUT_OF_RANGE && refused.text().contains("hands[0].tool is 5"), "{refused}");
    assert_eq!(error(Loop::create(&mut sim, &host_driven(), vec![])).code(), Code::EMPTY);
    Loop::create(&mut sim, &host_driven(), vec![(hand, &mut device)]).unwrap();
}

#[test]
fn tools_without_a_hand_are_placed() {
    let mut sim = pressed_cube();
    sim.add_tool(&ToolDef { shape: Tool::BALL, ..ToolDef::default() }).unwrap();
    let (hand, mut device) = hand();
    let mut feel = Loop::create(&mut sim, &host_driven(), vec![(hand, &mut device)]).unwrap();
    feel.place(1, &Pose { position: [0.1, 0.1, 0.1], ..Pose::default() }).unwrap();
    assert_eq!(error(feel.place(0, &Pose::default())).code(), Code::STATE);
    feel.tick().unwrap();
}

#[test]
fn the_papers_preset_changes_loop_and_hands() {
    let (mut def, mut hands) = (LoopDef::default(), [HandDef::default(), HandDef::default()]);
    def.apply_paper_preset(&mut hands).unwrap();
    assert_eq!(def.coupling, Coupling::PAPER);
    assert!(hands.iter().all(|h| !h.coupling && !h.inject_damping && !h.controller));
}

#[test]
fn a_forgotten_loop_leaves_no_way_to_harm() {
    let (mut sim, (hand, mut device)) = (pressed_cube(), hand());
    let def = LoopDef { driver: Driver::OWN_THREAD, priority: 0, ..LoopDef::default() };
    let mut feel = Loop::create(&mut sim, &def, vec![(hand, &mut device)]).unwrap();
    let monitor = feel.monitor();
    feel.start().unwrap();
    std::mem::forget(feel);
    assert_eq!(error(sim.view(array::POSITIONS_X)).code(), Code::BUSY);
    assert_eq!(error(device.read()).code(), Code::BUSY);
    drop((sim, device)); // refused by the library, which keeps them
    assert!(monitor.is_running().unwrap());
}

#[test]
fn a_device_of_ones_own_drives_a_loop_of_its_own_thread() {
    struct Still(std::sync::Arc<std::sync::atomic::AtomicU32>);
    impl CustomDevice for Still {
        fn read(&mut self, sample: &mut DeviceSample) -> Result<()> {
            sample.time = 1e-3 * f64::from(self.0.fetch_add(1, std::sync::atomic::Ordering::Relaxed));
            Ok(())
        }
        fn write(&mut self, _force: &[f64; 3], _torque: &[f64; 3]) -> Result<()> {
            Ok(())
        }
    }
    let reads = std::sync::Arc::new(std::sync::atomic::AtomicU32::new(0));
    let mut device =
        Device::open_custom(&DeviceDef::default(), &CustomDeviceDef::default(), Box::new(Still(reads.clone())))
            .unwrap();
    let (mut sim, hand) = (pressed_cube(), HandDef::default());
    let def = LoopDef { driver: Driver::OWN_THREAD, priority: 0, ..LoopDef::default() };
    let mut feel = Loop::create(&mut sim, &def, vec![(hand, &mut device)]).unwrap();
    feel.start().unwrap();
    while reads.load(std::sync::atomic::Ordering::Relaxed) < 20 {
        std::thread::sleep(Duration::from_millis(1));
    }
    feel.stop().unwrap();
    assert!(feel.status().unwrap().ticks >= 20);
}

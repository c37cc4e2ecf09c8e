//! What a simulation is, changed in mid-run.
use crate::{at_depth, cube, error, fixed_cube, press, pressed_cube};
use crumble::*;

/// The force after the change of a cube that was pressed, which goes on to be pressed a little deeper.
fn force_after(change: impl FnOnce(&mut Simulation)) -> f64 {
    let mut sim = pressed_cube();
    press(&mut sim, 100);
    change(&mut sim);
    (0..20).map(|_| sim.step(&at_depth(1.1e-3)).unwrap().force[1]).last().unwrap()
}

#[test]
fn the_same_again_changes_no_bit() {
    let (mut sim, mut twin) = (pressed_cube(), pressed_cube());
    press(&mut sim, 100);
    press(&mut twin, 100);
    let def = sim.def().unwrap();
    sim.configure(&def).unwrap();
    let tool = ToolDef::default();
    sim.set_tool(0, &tool).unwrap();
    sim.set_friction(0, tool.static_friction, tool.dynamic_friction).unwrap();
    sim.fix_below(1e-6).unwrap();
    sim.set_wall(0, &WallDef::default()).unwrap(); // the floor
    assert_eq!(sim.state_hash().unwrap(), twin.state_hash().unwrap());
    assert_eq!(sim.step_info().unwrap().step, 100);
    assert_eq!(sim.step(&at_depth(1.1e-3)).unwrap(), twin.step(&at_depth(1.1e-3)).unwrap());
    assert_eq!(sim.state_hash().unwrap(), twin.state_hash().unwrap());
}

#[test]
fn another_stiffness_changes_the_force() {
    let soft = force_after(|_| ());
    let stiff = force_after(|sim| {
        let def = SimDef { stiffness: 90.0, ..sim.def().unwrap() };
        sim.configure(&def).unwrap();
    });
    assert!(stiff > 1.5 * soft, "{stiff} {soft}");
}

#[test]
fn what_cannot_change_in_mid_run_is_said() {
    let mut sim = pressed_cube();
    press(&mut sim, 10);
    let hash = sim.state_hash().unwrap();
    let def = SimDef { tau: 0.0005, ..sim.def().unwrap() };
    let refused = error(sim.configure(&def));
    assert!(refused.code() == Code::STATE && refused.text().contains("tau is 0.001 and cannot become"), "{refused}");
    assert_eq!(error(sim.add_tool(&ToolDef::default())).code(), Code::STATE);
    assert_eq!(error(sim.add_attachment(&[3])).code(), Code::STATE);
    assert_eq!(sim.state_hash().unwrap(), hash);
    sim.reset().unwrap();
    sim.configure(&def).unwrap();
    assert_eq!(sim.add_tool(&ToolDef::default()).unwrap(), 1);
}

#[test]
fn another_tool_takes_the_place_of_one() {
    let mut sim = pressed_cube();
    press(&mut sim, 100);
    sim.set_tool(0, &ToolDef { radius: 0.002, ..ToolDef::default() }).unwrap();
    assert_eq!(sim.step(&at_depth(1e-3)).unwrap(), Wrench::default()); // it lets go
    sim.step(&at_depth(-5e-3)).unwrap();
    assert!(press(&mut sim, 400) > 0.001); // reaches 2 mm less far down
    let refused = error(sim.set_tool(1, &ToolDef::default()));
    assert!(refused.code() == Code::OUT_OF_RANGE && refused.text().contains("tool is 1"), "{refused}");
    let support = ToolDef { shape: Tool::SUPPORT, ..ToolDef::default() };
    assert_eq!(error(sim.set_tool(0, &support)).code(), Code::NULL);
}

#[test]
fn a_support_function_takes_the_place_of_another() {
    let ball = |radius: f64| move |d: [f64; 3]| [d[0] * radius, d[1] * radius, d[2] * radius];
    let (mut sim, mut twin) = (fixed_cube(), fixed_cube());
    sim.add_support_tool(&ToolDef::default(), ball(0.002)).unwrap();
    sim.set_support_tool(0, &ToolDef::default(), ball(0.004)).unwrap();
    twin.add_tool(&ToolDef { shape: Tool::BALL, radius: 0.004, ..ToolDef::default() }).unwrap();
    let (force, expected) = (press(&mut sim, 200), press(&mut twin, 200));
    assert!(expected > 0.01 && (force - expected).abs() < 0.02 * expected, "{force} {expected}");
    assert_eq!(error(sim.set_support_tool(0, &ToolDef::default(), |_| panic!("on purpose"))).code(), Code::INTERNAL);
    sim.set_tool(0, &ToolDef { shape: Tool::BALL, ..ToolDef::default() }).unwrap();
    sim.step(&at_depth(-5e-3)).unwrap(); // the one that panicked is forgotten
}

#[test]
fn friction_changes_what_a_tool_drags_along() {
    let dragged = |friction: f64| {
        let mut sim = fixed_cube();
        sim.add_tool(&ToolDef { static_friction: 0.5, dynamic_friction: 0.5, ..ToolDef::default() }).unwrap();
        press(&mut sim, 100);
        sim.set_friction(0, friction, friction).unwrap();
        let aside = |step: u32| Pose { position: [0.0, 0.023, 5e-5 * f64::from(step)], ..Pose::default() };
        (1..=60).map(|step| sim.step(&aside(step)).unwrap().force[2].abs()).last().unwrap()
    };
    assert!(dragged(0.0) < 0.5 * dragged(0.5), "{} {}", dragged(0.0), dragged(0.5));
    let refused = error(pressed_cube().set_friction(0, -1.0, 0.0));
    assert!(refused.text().starts_with("crumble_sim_set_friction: "), "{refused}");
    assert_eq!(error(pressed_cube().set_friction(1, 0.0, 0.0)).code(), Code::OUT_OF_RANGE);
}

#[test]
fn walls_move_and_are_added() {
    let mut sim = Simulation::create(&cube(), &SimDef::default()).unwrap();
    let lowest = |sim: &Simulation| sim.view(array::POSITIONS_Y).unwrap().iter().copied().fold(1.0, f64::min);
    sim.step_tools(&[], &mut []).unwrap();
    sim.set_wall(0, &WallDef { offset: 0.001, ..WallDef::default() }).unwrap(); // the floor
    sim.step_tools(&[], &mut []).unwrap();
    assert!(lowest(&sim) > 0.001 - 1e-9, "{}", lowest(&sim));
    sim.add_wall(&WallDef { offset: 0.002, ..WallDef::default() }).unwrap();
    sim.step_tools(&[], &mut []).unwrap();
    assert!(lowest(&sim) > 0.002 - 1e-9, "{}", lowest(&sim));
    assert_eq!(error(sim.set_wall(2, &WallDef::default())).code(), Code::OUT_OF_RANGE);
}

#[test]
fn nodes_fixed_in_mid_run_stop() {
    let mut sim = pressed_cube();
    press(&mut sim, 100);
    let all: Vec<u32> = (0u32..).zip(sim.view(array::POSITIONS_Y).unwrap()).map(|(i, _)| i).collect();
    sim.fix_nodes(&all).unwrap();
    let before = sim.copy(array::POSITIONS).unwrap();
    sim.step(&at_depth(-5e-3)).unwrap();
    assert_eq!(sim.copy(array::POSITIONS).unwrap(), before);
}

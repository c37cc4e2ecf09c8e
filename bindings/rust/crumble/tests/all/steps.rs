use crate::{at_depth, error, fixed_cube, press, pressed_cube};
use crumble::*;

#[test]
fn a_press_pushes_back_and_cuts() {
    let mut sim = pressed_cube();
    assert!(press(&mut sim, 100) > 0.001);
    let force = press(&mut sim, 1000);
    let counters = sim.counters().unwrap();
    assert!(force > 0.0 && counters.cuts > 0);
    let intact = sim.view(array::INTACT).unwrap();
    assert_eq!(intact.iter().filter(|&&i| i == 0).count() as u64, counters.cuts);
    let info = sim.step_info().unwrap();
    assert_eq!((info.step, info.status), (1100, 0));
    assert!((info.time - 1.1).abs() < 1e-9 && info.contacts > 0);
    let profile = sim.profile().unwrap();
    assert!(profile.solve_network > 0.0 && profile.solve_network < 1.0);
    assert!(sim.info().unwrap().lanes > 0);
}

#[test]
fn two_tools_and_an_attachment_have_a_wrench_each() {
    let mut sim = fixed_cube();
    sim.add_tool(&ToolDef::default()).unwrap();
    assert_eq!(sim.add_tool(&ToolDef { shape: Tool::BALL, ..ToolDef::default() }).unwrap(), 1);
    let held = (0u32..).zip(sim.view(array::POSITIONS_Y).unwrap()).filter(|(_, y)| **y > 0.0199).map(|(i, _)| i);
    let held: Vec<u32> = held.take(3).collect();
    assert_eq!(sim.add_attachment(&held).unwrap(), 0);
    assert_eq!(error(sim.add_attachment(&held)).code(), Code::STATE);
    assert_eq!(error(sim.add_attachment(&[])).code(), Code::EMPTY);
    assert_eq!(error(sim.step(&Pose::default())).code(), Code::OUT_OF_RANGE);

    let mut wrenches = [Wrench::default(); 3];
    for step in 0..200 {
        let down = at_depth(1e-5 * f64::from(step));
        let away = Pose { position: [0.1, 0.1, 0.1], ..Pose::default() };
        let up = Pose { position: [0.0, 1e-5 * f64::from(step), 0.0], ..Pose::default() };
        sim.step_tools(&[down, away, up], &mut wrenches).unwrap();
    }
    assert!(wrenches[0].force[1] > 0.0 && wrenches[2].force[1] < 0.0);
    assert_eq!(wrenches[1], Wrench::default());
    assert!(sim.held_drag(2).unwrap() > 0.0);
}

#[test]
fn an_advance_is_as_many_steps_with_the_mean_wrench() {
    let (mut sim, mut twin) = (pressed_cube(), pressed_cube());
    press(&mut sim, 100);
    press(&mut twin, 100);
    let mut mean = [Wrench::default()];
    let info = sim.advance(&[at_depth(1.2e-3)], &mut mean, 20, 0.0).unwrap();
    assert_eq!((info.steps, info.dropped, info.flags & StepFlag::DROPPED.0), (20, 0, 0));
    assert!((info.time - 0.12).abs() < 1e-12 && info.seconds > 0.0 && info.seconds < 10.0);
    let forces: f64 = (1..=20).map(|k| twin.step(&at_depth(1e-3 + 1e-5 * f64::from(k))).unwrap().force[1]).sum();
    assert!((mean[0].force[1] - forces / 20.0).abs() < 1e-6 * forces, "{mean:?} {forces}");
    assert_eq!(sim.step_info().unwrap().step, 120);
}

#[test]
fn steps_for_which_there_is_no_time_are_dropped() {
    let mut sim = pressed_cube();
    let mut wrenches = [Wrench::default()];
    let info = sim.advance(&[at_depth(1e-3)], &mut wrenches, 10, 1e-9).unwrap();
    assert_eq!((info.steps, info.dropped, info.flags & StepFlag::DROPPED.0), (1, 9, StepFlag::DROPPED.0));
    assert_eq!(sim.counters().unwrap().dropped_steps, 9);
    assert_eq!(sim.step_info().unwrap().step, 1);
    wrenches[0].force[1] = 1.0;
    let refused = error(sim.advance(&[at_depth(0.0)], &mut wrenches, 0, 0.0));
    assert!(refused.code() == Code::OUT_OF_RANGE && refused.text().contains("steps"), "{refused}");
    assert_eq!(error(sim.advance(&[at_depth(0.0)], &mut wrenches, 1, f64::NAN)).code(), Code::INVALID_VALUE);
    assert_eq!(error(sim.advance(&[at_depth(0.0)], &mut [], 1, 0.0)).code(), Code::OUT_OF_RANGE);
    assert_eq!(wrenches, [Wrench::default()]);
}

#[test]
fn the_books_of_energy_balance() {
    let mut plain = pressed_cube();
    assert_eq!(error(plain.energy()).code(), Code::STATE);
    let mut sim = pressed_cube();
    sim.configure(&SimDef { energy_audit: true, ..SimDef::default() }).unwrap();
    press(&mut plain, 1000);
    press(&mut sim, 1000);
    let e = sim.energy().unwrap();
    assert!(e.tool_work > 0.0 && e.stored > 0.0 && e.dissipated > 0.0 && e.cut > 0.0, "{e:?}");
    let balance = e.tool_work + e.external_work - e.dissipated - e.cut - e.stored;
    assert!(balance.abs() < 1e-9 * e.tool_work, "{balance} {e:?}");
    assert_eq!(sim.state_hash().unwrap(), plain.state_hash().unwrap());
}

#[test]
fn contacts_add_up_to_the_force() {
    let mut sim = pressed_cube();
    let force = press(&mut sim, 200);
    let of_tool: Vec<Contact> = sim.contacts().unwrap().into_iter().filter(|c| c.holder == 0).collect();
    assert_eq!(of_tool.len(), sim.step_info().unwrap().contacts as usize);
    assert!(of_tool
        .iter()
        .all(|c| [ContactState::FRESH, ContactState::STICKING, ContactState::SLIDING].contains(&c.state)));
    let sum: f64 = of_tool.iter().map(|c| -c.reaction[1]).sum();
    assert!((sum - force).abs() < 1e-9 * force.abs().max(1.0), "{sum} {force}");
}

#[test]
fn a_local_model_agrees_where_it_was_made() {
    let mut sim = pressed_cube();
    press(&mut sim, 200);
    let model = sim.local_model(0).unwrap();
    let there = model.evaluate(&model.at).unwrap();
    for axis in 0..3 {
        assert!((there.force[axis] - model.wrench.force[axis]).abs() < 1e-9);
    }
    let mut deeper = model.at;
    deeper.position[1] -= 1e-4;
    let on_another_thread = std::thread::spawn(move || model.evaluate(&deeper).unwrap()).join().unwrap();
    assert!(on_another_thread.force[1] > there.force[1]);
    assert_eq!(error(sim.local_model(7)).code(), Code::OUT_OF_RANGE);
}

#[test]
fn views_of_a_simulation_are_its_memory() {
    let mut sim = pressed_cube();
    press(&mut sim, 100);
    let (x, y, z) = (array::POSITIONS_X, array::POSITIONS_Y, array::POSITIONS_Z);
    let before = sim.view(y).unwrap().as_ptr();
    let first = sim.view(y).unwrap()[40];
    press(&mut sim, 300);
    assert_eq!(sim.view(y).unwrap().as_ptr(), before); // no copy was made of it, in either step
    assert_ne!(sim.view(y).unwrap()[40], first);
    let rows = sim.copy(array::POSITIONS).unwrap();
    let (x, y, z) = (sim.view(x).unwrap(), sim.view(y).unwrap(), sim.view(z).unwrap());
    assert!(rows.iter().enumerate().all(|(i, row)| *row == [x[i], y[i], z[i]]));
    assert_eq!(error(sim.view(array::POSITIONS)).code(), Code::UNSUPPORTED);
    assert!(sim.view(array::VELOCITIES_Y).unwrap().iter().any(|&v| v != 0.0));
}

#[test]
fn forces_on_nodes_move_them() {
    let mut sim = Simulation::create(&crate::cube(), &SimDef { gravity: [0.0; 3], ..SimDef::default() }).unwrap();
    let nodes = sim.view(array::POSITIONS_Y).unwrap().len();
    sim.set_node_forces(&vec![[0.0, 0.001, 0.0]; nodes]).unwrap();
    sim.set_node_force(3, &[0.0, 0.002, 0.0]).unwrap();
    sim.step_tools(&[], &mut []).unwrap();
    let speeds = sim.copy(array::VELOCITIES_Y).unwrap();
    assert!(speeds.iter().all(|&v| v > 0.0));
    assert_eq!(error(sim.set_node_forces(&[[0.0; 3]])).code(), Code::OUT_OF_RANGE);
    sim.set_node_forces(&[]).unwrap();
}

#[test]
fn a_simulation_steps_on_another_thread_with_the_same_bits() {
    let (mut here, mut there) = (pressed_cube(), pressed_cube());
    press(&mut here, 100);
    let there = std::thread::spawn(move || {
        press(&mut there, 100);
        there
    });
    assert_eq!(there.join().unwrap().state_hash().unwrap(), here.state_hash().unwrap());
}

use crate::{at_depth, cube, error, fixed_cube, press, pressed_cube};
use crumble::*;

#[test]
fn defaults_are_the_librarys() {
    let sim = SimDef::default();
    assert_eq!((sim.stiffness, sim.length_limit, sim.tau), (30.0, 1.3, 0.001));
    assert!(sim.floor && sim.ball_contact && !sim.mean_force && sim.kernel.is_none());
    assert_eq!((sim.gravity, sim.time_step_policy), ([0.0, -9.81, 0.0], Policy::GUARD));
    let tool = ToolDef::default();
    assert_eq!((tool.shape, tool.radius, tool.sides, tool.offset), (Tool::STICK, 0.004, 16, Pose::default()));
    assert_eq!(DeviceDef::default().replay_from, f64::NEG_INFINITY);
    assert_eq!(CustomDeviceDef::default().measured, Senses::POSITION.0);
    assert_eq!(WallDef::default().normal, [0.0, 1.0, 0.0]);
}

#[test]
fn a_definition_arrives_and_can_be_asked_for() {
    let mut sim = Simulation::create(&cube(), &SimDef { stiffness: 45.0, ..SimDef::default() }).unwrap();
    assert_eq!(sim.def().unwrap().stiffness, 45.0);
    let def = SimDef { floor: false, precision: Precision::FLOAT32, ..sim.def().unwrap() };
    sim.configure(&def).unwrap();
    assert_eq!(SimDef { kernel: None, ..sim.def().unwrap() }, SimDef { kernel: None, ..def });
}

#[test]
fn tools_of_every_shape_push_back() {
    let ball = ToolDef { shape: Tool::BALL, radius: 0.004, ..ToolDef::default() };
    for shape in [Tool::STICK, Tool::BALL, Tool::CAPSULE, Tool::BAR, Tool::BLADE] {
        let mut sim = fixed_cube();
        let bevel = if shape == Tool::BLADE { 0.004 } else { 0.0 };
        let def = ToolDef { shape, bevel, size: [0.008, 0.008, 0.03], length: 0.03, ..ball.clone() };
        assert_eq!(sim.add_tool(&def).unwrap(), 0, "{shape:?}");
        assert!(press(&mut sim, 200) > 0.01, "{shape:?}");
    }
    assert_eq!(error(fixed_cube().add_tool(&ToolDef { radius: -1.0, ..ball })).code(), Code::OUT_OF_RANGE);
}

#[test]
fn a_tool_of_a_mesh_is_copied() {
    let vertices = vec![[0.0, -0.004, 0.0], [0.02, 0.01, -0.02], [-0.02, 0.01, -0.02], [0.0, 0.01, 0.02]];
    let triangles = vec![[0, 2, 1], [0, 3, 2], [0, 1, 3], [1, 2, 3]];
    let mut def = ToolDef { shape: Tool::MESH, vertices, triangles, ..ToolDef::default() };
    let mut sim = fixed_cube();
    sim.add_tool(&def).unwrap();
    def.triangles.pop();
    assert_eq!(error(sim.add_tool(&def)).code(), Code::MESH);
    def.triangles.clear();
    assert_eq!(error(sim.add_tool(&def)).code(), Code::EMPTY);
    drop(def);
    assert!(press(&mut sim, 300) > 0.01);
}

#[test]
fn a_support_function_makes_the_same_ball() {
    let ball = ToolDef { shape: Tool::BALL, radius: 0.004, ..ToolDef::default() };
    let (mut by_shape, mut by_function) = (fixed_cube(), fixed_cube());
    by_shape.add_tool(&ball).unwrap();
    let radius = ball.radius;
    by_function.add_support_tool(&ball, move |d| [d[0] * radius, d[1] * radius, d[2] * radius]).unwrap();
    let (expected, force) = (press(&mut by_shape, 200), press(&mut by_function, 200));
    assert!(expected > 0.01 && (force - expected).abs() < 0.02 * expected, "{force} {expected}");
}

#[test]
fn a_support_function_that_panics_is_an_error() {
    let refused = error(fixed_cube().add_support_tool(&ToolDef::default(), |_| panic!("on purpose")));
    assert_eq!((refused.code(), refused.text()), (Code::INTERNAL, "a tool's support function panicked"));
    let mut sim = fixed_cube();
    let calls = std::sync::atomic::AtomicU32::new(0);
    let first_only = move |d: [f64; 3]| {
        assert!(calls.fetch_add(1, std::sync::atomic::Ordering::Relaxed) < 2000, "on purpose");
        [d[0] * 0.004, d[1] * 0.004, d[2] * 0.004]
    };
    sim.add_support_tool(&ToolDef::default(), first_only).unwrap();
    let failed = (0..500).find_map(|step| sim.step(&at_depth(1e-5 * f64::from(step))).err());
    assert_eq!(failed.map(|e| e.code()), Some(Code::INTERNAL));
}

#[test]
fn walls_stop_a_body_that_falls() {
    let mut sim = Simulation::create(&cube(), &SimDef { floor: false, ..SimDef::default() }).unwrap();
    sim.add_wall(&WallDef { offset: -0.001, ..WallDef::default() }).unwrap();
    for _ in 0..100 {
        sim.step_tools(&[], &mut []).unwrap();
    }
    let lowest = sim.view(array::POSITIONS_Y).unwrap().iter().copied().fold(1.0, f64::min);
    assert!((lowest + 0.001).abs() < 1e-4, "{lowest}");
    let slanted = WallDef { normal: [1.0, 1.0, 0.0], ..WallDef::default() };
    sim.reset().unwrap();
    assert_eq!(error(sim.add_wall(&slanted)).code(), Code::OUT_OF_RANGE);
}

#[test]
fn fixed_nodes_stay() {
    let mesh = cube();
    let mut sim = Simulation::create(&mesh, &SimDef { floor: false, ..SimDef::default() }).unwrap();
    sim.fix_nodes(&[0, 5]).unwrap();
    sim.fix_box(&[-1.0, 0.0195, -1.0], &[1.0, 1.0, 1.0]).unwrap();
    sim.fix_plane(&[0.0, 1.0, 0.0], 1e-6).unwrap();
    for _ in 0..20 {
        sim.step_tools(&[], &mut []).unwrap();
    }
    let rest = mesh.view(array::REST_POSITIONS).unwrap();
    let heights = sim.view(array::POSITIONS_Y).unwrap();
    let fixed = |i: usize| i == 0 || i == 5 || rest[i][1] >= 0.0195 || rest[i][1] <= 1e-6;
    assert!((0..rest.len()).all(|i| (heights[i] == rest[i][1]) == fixed(i)));
    sim.reset().unwrap();
    assert_eq!(error(sim.fix_nodes(&[1_000_000])).code(), Code::OUT_OF_RANGE);
}

#[test]
fn the_papers_preset_is_the_papers() {
    let mut sim = pressed_cube();
    sim.apply_paper_preset().unwrap();
    let def = sim.def().unwrap();
    assert_eq!((def.tau, def.contact_rule, def.mean_force), (0.0029, ContactRule::ALONG_MOTION, true));
}

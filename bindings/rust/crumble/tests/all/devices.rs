use crate::error;
use crumble::*;

#[test]
fn a_press_goes_straight_down() {
    let def = DeviceDef {
        kind: DeviceKind::named("press").unwrap(),
        press_speed: 0.01,
        press_depth: 0.005,
        ..DeviceDef::default()
    };
    let mut device = Device::open(&def).unwrap();
    assert_eq!(device.info().unwrap().kind, DeviceKind::PRESS);
    assert_eq!(device.text().unwrap(), "");
    let samples: Vec<DeviceSample> = (0..1000).map(|_| device.read().unwrap()).collect();
    assert!((samples[100].pose.position[1] + 0.001).abs() < 1e-9);
    assert_eq!(samples[999].status, ReadStatus::FINISHED);
    assert!((samples[999].pose.position[1] + 0.005).abs() < 1e-12);
    let refused = error(Device::open(&DeviceDef { press_speed: 0.0, ..def }));
    assert!(refused.text().contains("press_speed must be positive"), "{refused}");
}

#[test]
fn a_path_goes_through_its_points() {
    let points = vec![
        MotionPoint { time: 0.0, ..MotionPoint::default() },
        MotionPoint { time: 0.1, move_: [0.01, 0.0, 0.0], ..MotionPoint::default() },
    ];
    let mut device = Device::open(&DeviceDef { kind: DeviceKind::PATH, points, ..DeviceDef::default() }).unwrap();
    let halfway = (0..51).map(|_| device.read().unwrap()).last().unwrap();
    assert!((halfway.pose.position[0] - 0.005).abs() < 1e-9);
    let empty = DeviceDef { kind: DeviceKind::PATH, ..DeviceDef::default() };
    assert_eq!(error(Device::open(&empty)).code(), Code::EMPTY);
}

#[test]
fn a_hand_feels_the_force() {
    let points = vec![MotionPoint { time: 1.0, ..MotionPoint::default() }];
    let def = DeviceDef { kind: DeviceKind::HAND, points, ..DeviceDef::default() };
    let (mut left, mut pushed) = (Device::open(&def).unwrap(), Device::open(&def).unwrap());
    let mut last = [0.0; 2];
    for _ in 0..100 {
        last = [left.read().unwrap().pose.position[1], pushed.read().unwrap().pose.position[1]];
        left.write(&[0.0; 3], None).unwrap();
        pushed.write(&[0.0, 1.0, 0.0], Some(&[0.0; 3])).unwrap();
    }
    assert!(last[0].abs() < 1e-9 && last[1] > 1e-3, "{last:?}");
    assert_eq!(error(pushed.write(&[f64::NAN, 0.0, 0.0], None)).code(), Code::INVALID_VALUE);
}

#[test]
fn kinds_have_names() {
    let names: Vec<&str> = DeviceKind::names().collect();
    assert!(names.contains(&"hand") && names.contains(&"press"));
    assert_eq!(DeviceKind::named("hand").unwrap(), DeviceKind::HAND);
    assert!(error(DeviceKind::named("mouse")).text().contains("mouse"));
    assert!(find_attached(None).is_ok());
}

struct Shaker {
    reads: u32,
    fail_at: u32,
    sent: std::sync::mpsc::Sender<[f64; 3]>,
}

impl CustomDevice for Shaker {
    fn read(&mut self, sample: &mut DeviceSample) -> Result<()> {
        self.reads += 1;
        if self.reads == self.fail_at {
            return Err(Error::new(Code::IO, "unplugged"));
        }
        assert!(self.reads != 2 * self.fail_at, "on purpose");
        sample.time = f64::from(self.reads) * 1e-3;
        sample.pose.position[0] = f64::from(self.reads);
        Ok(())
    }

    fn write(&mut self, force: &[f64; 3], _torque: &[f64; 3]) -> Result<()> {
        let _ = self.sent.send(*force);
        Ok(())
    }
}

#[test]
fn a_device_of_ones_own_is_read_and_written() {
    let (sent, received) = std::sync::mpsc::channel();
    let shaker = Box::new(Shaker { reads: 0, fail_at: 4, sent });
    let custom = CustomDeviceDef { name: Some("shaker".to_string()), max_force: 2.0, ..CustomDeviceDef::default() };
    let def = DeviceDef { record_capacity: 10, ..DeviceDef::default() };
    let mut device = Device::open_custom(&def, &custom, shaker).unwrap();
    let info = device.info().unwrap();
    assert_eq!((info.name.as_str(), info.max_force, info.kind), ("shaker", 2.0, DeviceKind::CUSTOM));
    for k in 1..4 {
        assert_eq!(device.read().unwrap().pose.position[0], f64::from(k));
    }
    device.write(&[0.5, 0.0, 0.0], None).unwrap();
    assert_eq!(received.recv().unwrap(), [0.5, 0.0, 0.0]);
    assert_eq!(error(device.read()).code(), Code::DEVICE_LOST);
    assert_eq!(device.info().unwrap().callback_error, Code::IO.0);
    assert_ne!(device.text().unwrap(), "");
    drop(device);
    assert!(received.iter().all(|force| force == [0.0; 3])); // ends: the device is gone too
}

#[test]
fn a_device_that_panics_is_lost() {
    let (sent, _received) = std::sync::mpsc::channel();
    let shaker = Box::new(Shaker { reads: 1, fail_at: 1, sent });
    let mut device = Device::open_custom(&DeviceDef::default(), &CustomDeviceDef::default(), shaker).unwrap();
    assert_eq!(error(device.read()).code(), Code::DEVICE_LOST);
    assert_eq!(device.info().unwrap().callback_error, Code::INTERNAL.0);
    let servo = CustomDeviceDef { flags: DeviceFlag::SERVO_DRIVEN.0, ..CustomDeviceDef::default() };
    let (sent, _received) = std::sync::mpsc::channel();
    let shaker = Box::new(Shaker { reads: 0, fail_at: 0, sent });
    assert_eq!(error(Device::open_custom(&DeviceDef::default(), &servo, shaker)).code(), Code::NULL);
}

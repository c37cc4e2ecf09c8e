//! What belongs to the process: log and memory.
use crate::{cube, error, pressed_cube};
use crumble::*;
use std::sync::{Arc, Mutex};

/// Tests on other threads fail on purpose meanwhile; what they do is told on theirs.
#[test]
fn the_log_tells_of_errors_and_notes_in_the_thread_that_calls() {
    let here = std::thread::current().id();
    let told = Arc::new(Mutex::new(Vec::new()));
    let listen = |told: &Arc<Mutex<Vec<(Log, String)>>>| {
        let told = told.clone();
        Some(Box::new(move |level: Log, text: &str| {
            if std::thread::current().id() != here {
                return;
            }
            told.lock().unwrap().push((level, text.to_string()));
            if text.contains("crumble_mesh_copy") {
                panic!("on purpose");
            }
            version(); // the function may call the API
        }) as Box<dyn Fn(Log, &str) + Send + Sync>)
    };
    log_set(listen(&told)).unwrap();
    let refused = error(cube().view(array::POSITIONS_X));
    assert_eq!(*told.lock().unwrap(), [(Log::ERROR, refused.text().to_string())]);
    let copy = error(cube().copy(array::POSITIONS)); // the function panics, and the call says what it said without
    assert!(copy.text().starts_with("crumble_mesh_copy"), "{copy}");
    told.lock().unwrap().clear();
    Device::open(&DeviceDef::default()).unwrap();
    let after_open = told.lock().unwrap().clone();
    assert!(after_open.iter().any(|(level, _)| *level == Log::NOTE), "{after_open:?}");

    // Another function in its place: the first is not called.
    let others = Arc::new(Mutex::new(Vec::new()));
    log_set(listen(&others)).unwrap();
    told.lock().unwrap().clear();
    error(cube().view(array::POSITIONS_X));
    assert_eq!((told.lock().unwrap().len(), others.lock().unwrap().len()), (0, 1));

    log_set(None).unwrap();
    error(cube().view(array::POSITIONS_X));
    assert_eq!(others.lock().unwrap().len(), 1);
    while Arc::strong_count(&others) > 1 {
        std::thread::yield_now(); // another thread may still be in it; then it is freed
    }
}

#[test]
fn memory_is_counted() {
    let (mesh, sim) = (cube(), pressed_cube());
    let info = memory_info().unwrap();
    let positions = mesh.view(array::REST_POSITIONS).unwrap().len() as u64 * 24;
    assert!(info.blocks > 0 && info.bytes > 2 * positions && info.most_bytes >= info.bytes, "{info:?}");
    assert_eq!(info.longest_free, 0);
    drop((mesh, sim));
}

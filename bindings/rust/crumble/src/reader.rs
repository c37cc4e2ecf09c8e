use crate::arrays::{copy_of, rows_of, Array, Row};
use crate::convert::{count, Strings};
use crate::generated::{Code, Event, FragmentInfo, List, ReaderDef, ReaderInfo};
use crate::{Error, Result, Simulation};
use crumble_sys as sys;

/// Looks at a simulation from another thread, which draws, listens or logs at its own pace. Neither thread ever waits
/// for the other. A reader outlives its simulation, with the last state; while a simulation has readers it gets no
/// more tools and attachments.
#[derive(Debug)]
pub struct Reader {
    handle: sys::crumble_reader,
}

// crumble.h: [one], from any thread, by one at a time.
unsafe impl Send for Reader {}

impl Reader {
    /// Holds the state that the simulation is in.
    pub fn create(sim: &Simulation, def: &ReaderDef) -> Result<Self> {
        let c = def.as_c(&mut Strings::default())?;
        let mut handle = std::ptr::null_mut();
        Error::check(unsafe { sys::crumble_reader_create(sim.handle, &c, &mut handle) })?;
        Ok(Self { handle })
    }

    /// Takes the newest state, brings the arrays and the surface up to it, and asks for the next.
    pub fn update(&mut self) -> Result<ReaderInfo> {
        let mut c = sys::crumble_reader_info::default();
        Error::check(unsafe { sys::crumble_reader_update(self.handle, &mut c) })?;
        Ok(ReaderInfo::from_c(&c))
    }

    /// An array of the reader as the last update left it, without a copy.
    pub fn view<T: Row>(&self, which: Array<T>) -> Result<&[T]> {
        let mut view = sys::crumble_view::default();
        Error::check(unsafe { sys::crumble_reader_get_view(self.handle, which.number(), &mut view) })?;
        unsafe { rows_of(&view) } // valid until the next update, which takes &mut self, or destroy
    }

    /// The same array as a copy.
    pub fn copy<T: Row>(&self, which: Array<T>) -> Result<Vec<T>> {
        copy_of(which, |which, dst, size, needed| unsafe {
            sys::crumble_reader_copy(self.handle, which, dst, size, needed)
        })
    }

    /// One fragment as of the last update. The first call after an update measures all of them.
    pub fn fragment(&self, fragment: u32) -> Result<FragmentInfo> {
        let mut c = sys::crumble_fragment_info::default();
        Error::check(unsafe { sys::crumble_reader_get_fragment(self.handle, fragment, &mut c) })?;
        Ok(FragmentInfo::from_c(&c))
    }

    /// Its nodes, tetrahedra or triangles, without a copy.
    pub fn fragment_list(&self, fragment: u32, which: List) -> Result<&[u32]> {
        let mut view = sys::crumble_view::default();
        Error::check(unsafe { sys::crumble_reader_get_fragment_list(self.handle, fragment, which.0, &mut view) })?;
        unsafe { rows_of(&view) } // valid until the next update, which takes &mut self, or destroy
    }

    /// Spreads texture coordinates over the skin: u and v at each corner of the triangles of
    /// [`BOUNDARY`](crate::array::BOUNDARY) in, of the skin's triangles out.
    pub fn spread_over_skin(&self, boundary: &[[f32; 6]]) -> Result<Vec<[f32; 6]>> {
        let sources = self.view(crate::array::SURFACE_SKIN_SOURCES)?;
        let rows = boundary.len();
        if let Some(source) = sources.iter().find(|&&source| source as usize >= rows) {
            let text = format!("boundary has {rows} rows; the skin has a part of triangle {source}");
            return Err(Error::new(Code::OUT_OF_RANGE, text));
        }
        let mut skin = vec![[0.0f32; 6]; sources.len()];
        let room = count("skin", skin.len())?;
        let (from, to) = (boundary.as_ptr() as *const f32, skin.as_mut_ptr() as *mut f32);
        Error::check(unsafe { sys::crumble_reader_spread_over_skin(self.handle, from, to, room) })?;
        Ok(skin)
    }

    /// Takes the oldest events that this reader has not read, at most `capacity`. No update needed.
    pub fn read_events(&mut self, capacity: u32) -> Result<Vec<Event>> {
        let mut events = vec![sys::crumble_event::default(); capacity as usize];
        let mut count = 0;
        Error::check(unsafe {
            sys::crumble_reader_read_events(self.handle, events.as_mut_ptr(), capacity, &mut count)
        })?;
        Ok(events[..count as usize].iter().map(Event::from_c).collect())
    }
}

impl Drop for Reader {
    fn drop(&mut self) {
        unsafe { sys::crumble_reader_destroy(self.handle) };
    }
}

use crate::convert::{owned, static_text};
use crate::generated::Code;
use crumble_sys as sys;
use std::fmt;

/// What the library answered in place of a result: a code and the text of `crumble_last_error`, which names function,
/// field and value.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Error {
    code: Code,
    text: String,
}

/// The result of everything that can fail.
pub type Result<T> = std::result::Result<T, Error>;

impl Error {
    /// For the callbacks of a [`CustomDevice`](crate::CustomDevice).
    pub fn new(code: Code, text: impl Into<String>) -> Self {
        Self { code, text: text.into() }
    }

    pub fn code(&self) -> Code {
        self.code
    }

    /// "CRUMBLE_E_NULL" and so on.
    pub fn name(&self) -> &'static str {
        static_text(unsafe { sys::crumble_result_name(self.code.0) }).unwrap_or("unknown")
    }

    pub fn text(&self) -> &str {
        &self.text
    }

    /// To be called right after the call on the same thread, to which the text belongs.
    pub(crate) fn check(result: sys::crumble_result) -> Result<()> {
        if result == sys::CRUMBLE_OK {
            return Ok(());
        }
        let text = owned(unsafe { sys::crumble_last_error() }).unwrap_or_default();
        Err(Error { code: Code(result), text })
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.name(), self.text)
    }
}

impl std::error::Error for Error {}

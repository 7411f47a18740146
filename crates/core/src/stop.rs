//! A wish to stop, which whatever takes long looks at now and then.
//!
//! Knows whom to ask. Does not know who wishes it, or why.

/// Who is asked whether to stop.
#[derive(Clone, Copy, Default)]
pub struct Stop<'a>(Option<&'a (dyn Fn() -> bool + Sync)>);

impl<'a> Stop<'a> {
    /// Nobody: the work goes on to its end.
    pub fn never() -> Self {
        Self(None)
    }

    /// Stops once `asked` says so; it is asked from any thread, some hundred times a second at most.
    pub fn when(asked: &'a (dyn Fn() -> bool + Sync)) -> Self {
        Self(Some(asked))
    }

    /// Whether to stop.
    pub fn is_asked(self) -> bool {
        self.0.is_some_and(|asked| asked())
    }
}

impl std::fmt::Debug for Stop<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_tuple("Stop").field(&self.0.map(|asked| asked())).finish()
    }
}

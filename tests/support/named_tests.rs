//! Named tests from lists of files, pages and systems. `cargo test --test listed four_bar` runs those of one.

use libtest_mimic::{Arguments, Trial};

/// Returns whether the command line selects a test.
pub fn is_requested(name: &str) -> bool {
    !Arguments::from_args().is_filtered_out(&Trial::test(name, || Ok(())))
}

/// Tests under construction, by name.
#[derive(Default)]
pub struct Tests(Vec<Trial>);

impl Tests {
    /// Adds a test, which fails by panicking.
    pub fn add(&mut self, name: impl Into<String>, test: impl FnOnce() + Send + 'static) {
        self.0.push(Trial::test(name, move || {
            test();
            Ok(())
        }));
    }

    /// Adds a test `group::name` for each item of a list with at least a given length.
    pub fn each<T: Send + 'static>(
        &mut self,
        group: &str,
        list: impl IntoIterator<Item = (String, T)>,
        at_least: usize,
        test: impl Fn(T) + Copy + Send + 'static,
    ) {
        let before = self.0.len();
        for (name, item) in list {
            self.add(format!("{group}::{name}"), move || test(item));
        }
        let count = self.0.len() - before;
        assert!(count >= at_least, "only {count} of `{group}`");
    }

    /// Runs the tests that the command line selects.
    pub fn run(self) -> ! {
        libtest_mimic::run(&Arguments::from_args(), self.0).exit()
    }
}

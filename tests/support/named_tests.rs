//! Tests by name that are made of a list: of files, pages, systems. `cargo test --test listed four_bar` runs those of one.

use libtest_mimic::{Arguments, Trial};

/// Whether the command line asks for a test of a name.
pub fn is_requested(name: &str) -> bool {
    !Arguments::from_args().is_filtered_out(&Trial::test(name, || Ok(())))
}

/// Tests in the making, by their names.
#[derive(Default)]
pub struct Tests(Vec<Trial>);

impl Tests {
    /// One more; it fails by panicking.
    pub fn add(&mut self, name: impl Into<String>, test: impl FnOnce() + Send + 'static) {
        self.0.push(Trial::test(name, move || {
            test();
            Ok(())
        }));
    }

    /// One for each of a list, `group::name`; there are at least so many.
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

    /// Runs those that the command line asks for.
    pub fn run(self) -> ! {
        libtest_mimic::run(&Arguments::from_args(), self.0).exit()
    }
}

//! Typed ids of bodies, points, axes, circles and declarations, and lists that are indexed by them.
//!
//! Rows and coordinates have no such types: their numbers are positions in `Φ` and `q`, and thus in every numeric vector and matrix outside
//! this crate, where each id would have to be unwrapped again.

use std::marker::PhantomData;
use std::ops::{Deref, DerefMut, Index, IndexMut};

macro_rules! ids {
    ($($(#[$doc:meta])* $id:ident)*) => {$(
        $(#[$doc])*
        #[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default, Debug)]
        pub struct $id(u32);

        impl $id {
            /// Returns the position in the list, from 0.
            #[must_use]
            pub fn index(self) -> usize {
                self.0 as usize
            }
        }

        impl From<usize> for $id {
            fn from(index: usize) -> $id {
                $id(index as u32)
            }
        }

        impl From<$id> for usize {
            fn from(id: $id) -> usize {
                id.index()
            }
        }
    )*};
}

ids! {
    /// A body.
    BodyId
    /// A point of a body or of the ground.
    PointId
    /// An axis of a body or of the ground.
    AxisId
    /// A circle of a body or of the ground.
    CircleId
    /// A joint, constraint or driver.
    DeclarationId
}

/// A list that is indexed by ids of one type.
#[derive(Clone, Debug)]
pub struct IdVec<I, T> {
    items: Vec<T>,
    by: PhantomData<fn(I) -> I>,
}

impl<I: From<usize>, T> IdVec<I, T> {
    /// Returns the ids of all items, in order.
    pub fn ids(&self) -> impl DoubleEndedIterator<Item = I> + ExactSizeIterator + Clone + use<I, T> {
        (0..self.items.len()).map(I::from)
    }

    /// Returns all items with their ids, in order.
    #[must_use]
    pub fn pairs(&self) -> impl DoubleEndedIterator<Item = (I, &T)> {
        self.items.iter().enumerate().map(|(k, item)| (I::from(k), item))
    }

    /// Maps each item to a new list with the same ids.
    pub fn map<U>(&self, of: impl Fn(&T) -> U) -> IdVec<I, U> {
        self.items.iter().map(of).collect()
    }

    /// Returns the id of the first item that satisfies a predicate.
    pub fn find(&self, holds: impl Fn(&T) -> bool) -> Option<I> {
        self.items.iter().position(holds).map(I::from)
    }

    /// Returns the id that the next item will have.
    #[must_use]
    pub fn next_id(&self) -> I {
        I::from(self.items.len())
    }

    /// Appends an item and returns its id.
    pub fn push(&mut self, item: T) -> I {
        self.items.push(item);
        I::from(self.items.len() - 1)
    }
}

impl<I, T> Default for IdVec<I, T> {
    fn default() -> Self {
        IdVec { items: Vec::new(), by: PhantomData }
    }
}

impl<I, T> FromIterator<T> for IdVec<I, T> {
    fn from_iter<A: IntoIterator<Item = T>>(items: A) -> Self {
        IdVec { items: items.into_iter().collect(), by: PhantomData }
    }
}

impl<I, T> Deref for IdVec<I, T> {
    type Target = [T];
    fn deref(&self) -> &[T] {
        &self.items
    }
}

impl<I, T> DerefMut for IdVec<I, T> {
    fn deref_mut(&mut self) -> &mut [T] {
        &mut self.items
    }
}

impl<I: Into<usize>, T> Index<I> for IdVec<I, T> {
    type Output = T;
    fn index(&self, id: I) -> &T {
        &self.items[id.into()]
    }
}

impl<I: Into<usize>, T> IndexMut<I> for IdVec<I, T> {
    fn index_mut(&mut self, id: I) -> &mut T {
        &mut self.items[id.into()]
    }
}

impl<'l, I, T> IntoIterator for &'l IdVec<I, T> {
    type Item = &'l T;
    type IntoIter = std::slice::Iter<'l, T>;
    fn into_iter(self) -> Self::IntoIter {
        self.items.iter()
    }
}

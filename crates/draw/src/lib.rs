//! Drawings of mechanisms and their motion: `scene` holds what is drawn, `view` writes it.

pub mod scene;
pub mod view;

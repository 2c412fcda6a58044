//! Our STEP files in OpenCASCADE's eyes.

#![allow(clippy::unwrap_used, reason = "a panic is how a test fails")]

mod fixtures;
mod opencascade;
mod program;
mod quadrics;
mod solids;
#[path = "../stages/mod.rs"]
mod stages;
#[path = "../support/mod.rs"]
mod support;

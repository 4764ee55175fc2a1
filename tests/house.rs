//! The house itself: rooms, registries, recipes, generated text, and the command.

mod cli;
mod command;
mod counted;
mod engine_pages;
mod examples;
mod layering;
mod layout;
mod mutants;
mod programs;
mod readme;
mod recipes;
mod registry;
mod tolerance;
mod writes;

//! Studies of the program by itself: verification against exact answers and the method paper.

pub mod verify;

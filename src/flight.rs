//! Free flight.

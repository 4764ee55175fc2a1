//! Closed forms and limits that are not in the code.

//! Global pose.

//! Host and port of an address.

use std::net::{IpAddr, Ipv6Addr};

/// What is wrong with a host or its port, as they were given.
pub(super) enum HostError {
    Host { host: String },
    Port { port: String },
}

/// The host and the port, or the usual one.
pub(super) fn host_and_port(place: &str, usual: u16) -> Result<(&str, u16), HostError> {
    // The colons of an IPv6 address stand in brackets.
    let end = place.find(']').map_or(0, |end| end + 1);
    let (host, port) = match place[end..].split_once(':') {
        Some((rest, port)) => (&place[..end + rest.len()], Some(port)),
        None => (place, None),
    };
    let is_letter = |c: char| c.is_alphanumeric() || "-._".contains(c);
    let is_host = match host.strip_prefix('[') {
        Some(inner) => inner
            .strip_suffix(']')
            .is_some_and(|inner| inner.parse::<Ipv6Addr>().is_ok()),
        None => !host.is_empty() && host.chars().all(is_letter),
    };
    if !is_host {
        let host = host.to_owned();
        return Err(HostError::Host { host });
    }
    let port = match port {
        None => usual,
        Some(text) => match text.parse() {
            Ok(port) if port > 0 => port,
            _ => return Err(HostError::Port { port: text.into() }),
        },
    };
    Ok((host, port))
}

/// True for this computer by a name or an IP address, in brackets or not.
pub(super) fn is_loopback(host: &str) -> bool {
    let address = host.trim_matches(['[', ']']).parse::<IpAddr>();
    host == "localhost" || address.is_ok_and(|address| address.is_loopback())
}

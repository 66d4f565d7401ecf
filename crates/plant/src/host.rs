//! Host and port in an address.

use std::net::{IpAddr, Ipv6Addr};

/// An invalid host or port, as given.
pub(super) enum HostError {
    Host { host: String },
    Port { port: String },
}

/// Splits an address into the host and the port, which defaults to `usual`.
pub(super) fn host_and_port(place: &str, usual: u16) -> Result<(&str, u16), HostError> {
    // The colons of an IPv6 address are within brackets.
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

/// True if the host is `localhost` or a loopback address, in brackets or not.
pub(super) fn is_loopback(host: &str) -> bool {
    let address = host.trim_matches(['[', ']']).parse::<IpAddr>();
    host == "localhost" || address.is_ok_and(|address| address.is_loopback())
}

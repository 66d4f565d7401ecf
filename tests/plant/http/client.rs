//! A minimal HTTP/1.1 client that sends exactly what it is told to.

use std::{
    io::{self, BufRead as _, BufReader, Read, Write},
    net::{SocketAddr, TcpStream},
};

use serde_json::Value;

use super::PATIENCE;

/// A connection, plain or encrypted.
pub(crate) struct Client<S: Read + Write = TcpStream> {
    stream: BufReader<S>,
    /// Sent with every request, each with its line end.
    pub(crate) fields: String,
}

/// An answer of the server.
#[derive(Debug)]
pub(crate) struct Reply {
    pub(crate) status: u16,
    head: Vec<(String, String)>,
    pub(crate) text: String,
}

impl Reply {
    /// The first field of this name, which must be in lower case.
    pub(crate) fn field(&self, name: &str) -> &str {
        let field = self.head.iter().find(|(other, _)| other == name);
        field.map_or("", |(_, value)| value)
    }

    pub(crate) fn json(&self) -> Value {
        assert_eq!(self.field("content-type"), "application/json", "{self:?}");
        serde_json::from_str(&self.text).expect("JSON")
    }
}

pub(crate) fn connect(address: SocketAddr) -> TcpStream {
    let stream = TcpStream::connect(address).expect("connected");
    stream.set_read_timeout(Some(PATIENCE)).expect("set");
    stream.set_write_timeout(Some(PATIENCE)).expect("set");
    stream
}

impl Client {
    pub(crate) fn connect(address: SocketAddr) -> Self {
        Self::over(connect(address))
    }
}

impl<S: Read + Write> Client<S> {
    pub(crate) fn over(stream: S) -> Self {
        Self {
            stream: BufReader::new(stream),
            fields: String::new(),
        }
    }

    /// Makes the client send this token.
    pub(crate) fn with_token(mut self, token: &str) -> Self {
        self.fields = format!("Authorization: Bearer {token}\r\n");
        self
    }

    pub(crate) fn send(&mut self, bytes: &[u8]) -> io::Result<()> {
        let stream = self.stream.get_mut();
        stream.write_all(bytes)?;
        stream.flush()
    }

    pub(crate) fn get(&mut self, path: &str) -> Reply {
        self.ask("GET", path)
    }

    pub(crate) fn trigger(&mut self) -> Reply {
        self.ask("POST", "/v1/trigger")
    }

    /// Triggers with this body.
    pub(crate) fn trigger_with(&mut self, body: &str) -> Reply {
        let before = self.fields.clone();
        self.fields = format!("{before}Content-Length: {}\r\n", body.len());
        self.begin("POST", "/v1/trigger");
        self.fields = before;
        self.send(body.as_bytes()).expect("sent");
        self.reply().expect("an answer")
    }

    pub(crate) fn ask(&mut self, method: &str, path: &str) -> Reply {
        self.begin(method, path);
        self.reply().expect("an answer")
    }

    /// Sends a request and does not wait for its answer.
    pub(crate) fn begin(&mut self, method: &str, path: &str) {
        let fields = &self.fields;
        let request = format!("{method} {path} HTTP/1.1\r\nHost: 127.0.0.1\r\n{fields}\r\n");
        self.send(request.as_bytes()).expect("sent");
    }

    pub(crate) fn reply(&mut self) -> io::Result<Reply> {
        let line = self.line()?;
        let status = line.strip_prefix("HTTP/1.1 ");
        let status = status.and_then(|rest| rest.get(..3)?.parse().ok());
        let mut reply = Reply {
            status: status.ok_or(io::ErrorKind::InvalidData)?,
            head: Vec::new(),
            text: String::new(),
        };
        loop {
            let line = self.line()?;
            let Some((name, value)) = line.split_once(':') else {
                break;
            };
            let field = (name.to_ascii_lowercase(), value.trim().to_owned());
            reply.head.push(field);
        }
        let length = reply.field("content-length").parse().expect("a length");
        let mut text = vec![0; length];
        self.stream.read_exact(&mut text)?;
        reply.text = String::from_utf8(text).expect("text");
        Ok(reply)
    }

    fn line(&mut self) -> io::Result<String> {
        let mut line = String::new();
        if self.stream.read_line(&mut line)? == 0 {
            return Err(io::ErrorKind::UnexpectedEof.into());
        }
        Ok(line.trim_end().to_owned())
    }

    /// True once the server has closed the connection without a further byte.
    pub(crate) fn is_let_go(&mut self) -> bool {
        let mut rest = Vec::new();
        match self.stream.read_to_end(&mut rest) {
            Ok(_) => rest.is_empty(),
            Err(error) => error.kind() == io::ErrorKind::ConnectionReset,
        }
    }
}

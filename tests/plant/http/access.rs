//! Tokens, HTTPS, and the conditions for listening to the network.

use std::{
    fs,
    net::{IpAddr, TcpStream},
    process::Command,
    sync::Arc,
};

use partsight::{
    Advice as _,
    plant::http::{HttpError, HttpServer, HttpSettings, Tls, Tokens},
    serve::{CameraStatus, ClientNews, Server, ServerSettings},
};
use plant::tokio_rustls::rustls::{
    ClientConfig, ClientConnection, RootCertStore, StreamOwned,
    crypto::ring,
    pki_types::{CertificateDer, ServerName, pem::PemObject as _},
};
use serde_json::json;

use super::{
    Service, accepted, certificate,
    client::{Client, connect},
    http_settings, key, patient, tls, tokens,
};

const TOKEN: &str = "0123456789abcdef0123456789abcdef";

fn with_token() -> HttpSettings {
    HttpSettings {
        tokens: tokens(&format!("another-token-of-another\n{TOKEN}\n")),
        ..http_settings()
    }
}

/// An encrypted connection that trusts only the certificate of the tests.
fn encrypted(service: &Service) -> Client<StreamOwned<ClientConnection, TcpStream>> {
    let mut roots = RootCertStore::empty();
    let own = CertificateDer::from_pem_file(certificate()).expect("a certificate");
    roots.add(own).expect("added");
    let config = ClientConfig::builder_with_provider(Arc::new(ring::default_provider()))
        .with_safe_default_protocol_versions()
        .expect("versions")
        .with_root_certificates(roots)
        .with_no_client_auth();
    let name = ServerName::IpAddress(IpAddr::from([127, 0, 0, 1]).into());
    let session = ClientConnection::new(Arc::new(config), name).expect("a session");
    Client::over(StreamOwned::new(session, connect(service.address)))
}

#[test]
fn without_a_right_token_nothing_but_the_health_is_told() {
    let service = Service::start_with(patient(), with_token(), accepted);
    let mut good = service.client().with_token(TOKEN);
    assert_eq!(good.trigger().status, 200);
    for fields in [
        "",
        "Authorization: Bearer \r\n",
        "Authorization: Bearer 0123456789abcdef0123456789abcdeF\r\n",
        "Authorization: Bearer 0123456789abcdef\r\n",
        "Authorization: Basic 0123456789abcdef0123456789abcdef\r\n",
    ] {
        let mut bad = service.client();
        bad.fields = fields.into();
        for (method, path) in [
            ("POST", "/v1/trigger"),
            ("GET", "/v1/last"),
            ("GET", "/v1/path"),
            ("GET", "/v1/metrics"),
            ("GET", "/v1/openapi.json"),
            ("GET", "/elsewhere"),
        ] {
            let reply = bad.ask(method, path);
            assert_eq!(reply.status, 401, "{fields} {path}");
            assert_eq!(reply.field("www-authenticate"), "Bearer");
            let answer = reply.json();
            assert_eq!(answer["verdict"], "bad_request");
            assert_eq!(answer["problem"]["reason"], "wrong_token");
            assert!(answer["camera"].is_null() && answer["part"].is_null());
        }
        assert_eq!(bad.get("/v1/healthz").status, 200);
    }
    let mut other = service.client().with_token("another-token-of-another");
    assert_eq!(other.get("/v1/last").json()["sequence"], 1);
    assert_eq!(good.trigger().json()["sequence"], 2);
    assert_eq!(service.num_events(&ClientNews::WrongToken), 30);
}

/// Status of the answer to `GET /v1/last` with only these fields.
fn status_of(service: &Service, fields: &str) -> u16 {
    let mut client = service.client();
    let request = format!("GET /v1/last HTTP/1.1\r\n{fields}\r\n");
    client.send(request.as_bytes()).expect("sent");
    client.reply().expect("an answer").status
}

#[test]
fn a_web_page_may_not_ask_where_no_token_is_needed() {
    let service = Service::start(accepted);
    let mut page = service.client();
    page.fields = "Origin: http://example.com\r\n".into();
    let reply = page.trigger();
    assert_eq!(reply.status, 403);
    assert_eq!(reply.json()["problem"]["reason"], "web_page");
    for (fields, status) in [
        ("Host: 127.0.0.1:30180\r\n", 200),
        ("Host: localhost\r\n", 200),
        ("Host: [::1]:30180\r\n", 200),
        ("", 200),
        ("Host: localhost\r\nOrigin: null\r\n", 403),
        // DNS rebinding: a page whose host name resolves to this computer.
        ("Host: rebound.example.com:30180\r\n", 403),
        ("Host: \r\n", 403),
    ] {
        assert_eq!(status_of(&service, fields), status, "{fields}");
    }
    assert_eq!(service.num_inspected(), 0);
}

#[test]
fn tokens_are_lines_of_a_file_and_are_sent_as_http_says() {
    let service = Service::start_with(patient(), with_token(), accepted);
    for (sent, status) in [
        (format!("Bearer {TOKEN}"), 200),
        (format!("bearer  {TOKEN} "), 200),
        ("BEARER another-token-of-another".into(), 200),
        (format!("Basic {TOKEN}"), 401),
        (TOKEN.into(), 401),
        (format!("Bearer {TOKEN}0"), 401),
        (format!("Bearer {}", &TOKEN[1..]), 401),
    ] {
        let fields = format!("Host: plant\r\nAuthorization: {sent}\r\n");
        assert_eq!(status_of(&service, &fields), status, "{sent}");
    }
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("tokens");
    for (text, words) in [
        ("", "no token"),
        ("\n \r\n", "no token"),
        ("0123456789abcdef\nshort\n", "line 2"),
        ("0123456789 abcdef\n", "line 1"),
        ("0123456789abcd\u{e9}f\n", "line 1"),
    ] {
        fs::write(&path, text).expect("written");
        let Err(error) = Tokens::load(&path) else {
            panic!("{text:?} was taken");
        };
        assert!(error.to_string().contains(words), "{error}");
        assert!(error.advice().contains("openssl"), "{}", error.advice());
    }
}

#[test]
fn https_answers_as_http_does_and_plain_requests_get_nothing() {
    let settings = HttpSettings {
        tls: Some(tls()),
        ..with_token()
    };
    let service = Service::start_with(patient(), settings, accepted);
    let mut good = encrypted(&service).with_token(TOKEN);
    for sequence in 1..=3 {
        // A client that does not speak TLS is disconnected, at most with an alert.
        let mut plain = service.client().with_token(TOKEN);
        plain.begin("POST", "/v1/trigger");
        assert!(plain.reply().is_err());
        assert_eq!(encrypted(&service).trigger().status, 401);
        let answer = good.trigger().json();
        assert_eq!(
            (&answer["verdict"], &answer["sequence"]),
            (&json!("accepted"), &json!(sequence))
        );
    }
    assert_eq!(service.num_inspected(), 3);
}

/// curl verifies the certificate by itself.
#[test]
fn curl_gets_an_answer_over_https() {
    if Command::new("curl").arg("--version").output().is_err() {
        eprintln!(
            "skipped: curl is not installed; https_answers_as_http_does_and_plain_requests_get_nothing covers HTTPS"
        );
        return;
    }
    let settings = HttpSettings {
        tls: Some(tls()),
        ..with_token()
    };
    let service = Service::start_with(patient(), settings, accepted);
    let url = service.http.as_ref().expect("serving").url();
    assert!(
        url.starts_with("https://127.0.0.1:") && url.ends_with("/v1"),
        "{url}"
    );
    let token = format!("Authorization: Bearer {TOKEN}");
    let answered = Command::new("curl")
        .args([
            "--silent",
            "--show-error",
            "--max-time",
            "60",
            "--noproxy",
            "*",
            "--cacert",
        ])
        .arg(certificate())
        .args(["-X", "POST", "-H", &token, &format!("{url}/trigger")])
        .output()
        .expect("ran");
    let text = String::from_utf8_lossy(&answered.stdout);
    assert!(text.contains("\"verdict\":\"accepted\""), "{answered:?}");
}

#[test]
fn without_a_token_only_this_computer_is_listened_to() {
    let open = || HttpSettings {
        address: "0.0.0.0:0".parse().expect("an address"),
        ..with_token()
    };
    let server = || {
        let settings = ServerSettings::default();
        Server::start(&[], settings, CameraStatus::default, |_| ()).expect("started")
    };
    let settings = HttpSettings {
        tokens: Tokens::default(),
        ..open()
    };
    let Err(error) = HttpServer::start(settings, server().handle()) else {
        panic!("anybody could have asked");
    };
    assert!(
        matches!(error, HttpError::OpenWithoutToken { .. }),
        "{error}"
    );
    assert!(error.advice().contains("--http-token-file"));
    assert!(
        open()
            .doubt()
            .is_some_and(|doubt| doubt.advice().contains("--http-cert"))
    );
    let encrypted = HttpSettings {
        tls: Some(tls()),
        ..open()
    };
    assert_eq!((encrypted.doubt(), http_settings().doubt()), (None, None));
    let server = server();
    let http = HttpServer::start(encrypted, server.handle()).expect("started");
    assert!(http.url().starts_with("https://"));
    let taken = HttpSettings {
        address: http.address(),
        ..open()
    };
    let Err(error) = HttpServer::start(taken, server.handle()) else {
        panic!("the port is taken");
    };
    assert!(error.to_string().contains("another program"), "{error}");
    assert!(error.advice().contains("--http"), "{}", error.advice());
}

#[test]
fn files_that_are_no_certificate_or_key_are_refused_in_words() {
    let folder = tempfile::tempdir().expect("a folder");
    let text = folder.path().join("text.pem");
    fs::write(&text, "no certificate").expect("written");
    let other = folder.path().join("other.pem");
    let wrong = "-----BEGIN PRIVATE KEY-----\nAAAA\n-----END PRIVATE KEY-----\n";
    fs::write(&other, wrong).expect("written");
    for (certificate, key, words) in [
        (text.clone(), key(), "no certificate in PEM"),
        (certificate(), text.clone(), "no private key in PEM"),
        (key(), key(), "no certificate in PEM"),
        (certificate(), other, "cannot be used"),
    ] {
        let Err(error) = Tls::load(&certificate, &key) else {
            panic!("{words}");
        };
        assert!(error.to_string().contains(words), "{error}");
        assert!(!error.advice().is_empty());
    }
    assert!(Tls::load(&folder.path().join("missing"), &key()).is_err());
}

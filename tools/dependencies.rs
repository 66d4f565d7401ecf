//! What the program is built of, from `cargo metadata`; no other tool is needed:
//!
//! ```sh
//! cargo run --example dependencies -- sbom > partsight.cdx.json   # CycloneDX 1.5
//! cargo run --example dependencies -- unsafe                      # unsafe code of each dependency
//! cargo run --example dependencies -- licences                    # and how many dependencies have each
//! ```
#![expect(clippy::print_stdout, reason = "its output is what it is for")]

use std::{
    collections::{BTreeMap, BTreeSet},
    env, fs,
    path::Path,
    process::Command,
};

use serde_json::{Value, json};

type Outcome<T> = Result<T, Box<dyn std::error::Error>>;

/// A package that the program is built of.
struct Package {
    name: String,
    version: String,
    licence: String,
    repository: Option<String>,
    manifest: String,
    checksum: Option<String>,
    /// Identities of what it is built of in turn.
    needs: BTreeSet<String>,
}

impl Package {
    fn url(&self) -> String {
        format!("pkg:cargo/{}@{}", self.name, self.version)
    }

    /// Lines of its own code that say `unsafe`, without comments, tests and examples: a measure, no proof.
    fn unsafe_lines(&self) -> usize {
        let root = Path::new(&self.manifest).parent();
        root.map_or(0, |root| unsafe_lines(&root.join("src")))
    }
}

fn main() -> Outcome<()> {
    let (root, packages) = packages()?;
    match env::args().nth(1).as_deref() {
        Some("sbom") => println!("{:#}", sbom(&root, &packages)),
        Some("unsafe") => {
            println!("{:<32} {:<12} unsafe lines", "package", "version");
            for (id, package) in &packages {
                if *id != root {
                    let num = package.unsafe_lines();
                    println!("{:<32} {:<12} {num}", package.name, package.version);
                }
            }
        }
        Some("licences") => {
            let mut counts: BTreeMap<&str, usize> = BTreeMap::new();
            for package in packages.values() {
                *counts.entry(&package.licence).or_default() += 1;
            }
            for (licence, num) in counts {
                println!("{num:4}  {licence}");
            }
        }
        _ => return Err("sbom, unsafe or licences?".into()),
    }
    Ok(())
}

/// The program's identity, and all that it is built of on this system, itself included; what only tests need is left out.
fn packages() -> Outcome<(String, BTreeMap<String, Package>)> {
    let compiler = Command::new("rustc").arg("-vV").output()?;
    let compiler = String::from_utf8(compiler.stdout)?;
    let host = compiler
        .lines()
        .find_map(|line| line.strip_prefix("host: "));
    let read = Command::new(env::var_os("CARGO").unwrap_or_else(|| "cargo".into()))
        .args([
            "metadata",
            "--format-version=1",
            "--locked",
            "--filter-platform",
        ])
        .arg(host.ok_or("rustc names no host")?)
        .output()?;
    if !read.status.success() {
        return Err(String::from_utf8_lossy(&read.stderr).into());
    }
    let metadata: Value = serde_json::from_slice(&read.stdout)?;
    let text = |value: &Value| value.as_str().unwrap_or_default().to_owned();
    let list = |value: &Value| value.as_array().cloned().unwrap_or_default();
    let root = text(&metadata["resolve"]["root"]);
    let lock =
        fs::read_to_string(Path::new(&text(&metadata["workspace_root"])).join("Cargo.lock"))?;
    let checksums = checksums(&lock)?;

    let mut needs: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
    for node in list(&metadata["resolve"]["nodes"]) {
        let is_built_in = |dependency: &&Value| {
            let kinds = list(&dependency["dep_kinds"]);
            kinds.iter().any(|kind| kind["kind"] != "dev")
        };
        let dependencies = list(&node["deps"]);
        let dependencies = dependencies.iter().filter(is_built_in);
        let ids = dependencies.map(|dependency| text(&dependency["pkg"]));
        needs.insert(text(&node["id"]), ids.collect());
    }
    let mut found = BTreeSet::new();
    let mut waiting = vec![root.clone()];
    while let Some(id) = waiting.pop() {
        if found.insert(id.clone()) {
            waiting.extend(needs.get(&id).into_iter().flatten().cloned());
        }
    }
    let all = list(&metadata["packages"]);
    let all = all
        .iter()
        .filter(|package| found.contains(&text(&package["id"])));
    let packages = all.map(|package| {
        let (id, name) = (text(&package["id"]), text(&package["name"]));
        let version = text(&package["version"]);
        let package = Package {
            // Older packages separate alternatives by a slash.
            licence: text(&package["license"]).replace('/', " OR "),
            repository: package["repository"].as_str().map(str::to_owned),
            manifest: text(&package["manifest_path"]),
            checksum: checksums.get(&(name.clone(), version.clone())).cloned(),
            needs: needs.remove(&id).unwrap_or_default(),
            name,
            version,
        };
        (id, package)
    });
    Ok((root, packages.collect()))
}

/// The SHA-256 sums of what was downloaded, by name and version.
fn checksums(lock: &str) -> Outcome<BTreeMap<(String, String), String>> {
    let lock: toml::Table = lock.parse()?;
    let packages = lock.get("package").and_then(toml::Value::as_array);
    let word = |package: &toml::Value, key| Some(package.get(key)?.as_str()?.to_owned());
    let sums = packages.into_iter().flatten().filter_map(|package| {
        let key = (word(package, "name")?, word(package, "version")?);
        Some((key, word(package, "checksum")?))
    });
    Ok(sums.collect())
}

fn sbom(root: &str, packages: &BTreeMap<String, Package>) -> Value {
    let component = |package: &Package, kind: &str| {
        let mut component = json!({
            "type": kind,
            "bom-ref": package.url(),
            "name": package.name,
            "version": package.version,
            "purl": package.url(),
            "licenses": [{ "expression": package.licence }],
        });
        if let Some(sum) = &package.checksum {
            component["hashes"] = json!([{ "alg": "SHA-256", "content": sum }]);
        }
        if let Some(repository) = &package.repository {
            component["externalReferences"] = json!([{ "type": "vcs", "url": repository }]);
        }
        component
    };
    let others = packages.iter().filter(|(id, _)| *id != root);
    let dependencies = packages.values().map(|package| {
        let needs = package.needs.iter().filter_map(|id| packages.get(id));
        json!({ "ref": package.url(), "dependsOn": needs.map(Package::url).collect::<Vec<_>>() })
    });
    json!({
        "bomFormat": "CycloneDX",
        "specVersion": "1.5",
        "version": 1,
        "metadata": { "component": packages.get(root).map(|own| component(own, "application")) },
        "components": others.map(|(_, package)| component(package, "library")).collect::<Vec<_>>(),
        "dependencies": dependencies.collect::<Vec<_>>(),
    })
}

fn unsafe_lines(folder: &Path) -> usize {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    let counted = entries.map(|entry| {
        let path = entry.path();
        if path.is_dir() {
            return if path.ends_with("tests") {
                0
            } else {
                unsafe_lines(&path)
            };
        }
        if path.extension().is_none_or(|ending| ending != "rs") {
            return 0;
        }
        let text = fs::read_to_string(&path).unwrap_or_default();
        let code = text
            .lines()
            .map(|line| line.split("//").next().unwrap_or(""));
        let words = |line: &str| {
            let mut words = line.split(|letter: char| !letter.is_alphanumeric() && letter != '_');
            words.any(|word| word == "unsafe")
        };
        code.filter(|line| words(line)).count()
    });
    counted.sum()
}

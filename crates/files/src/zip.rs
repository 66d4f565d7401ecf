//! Writing of ZIP archives without compression, for files that hardly compress anyway: depth images and binary clouds.
//!
//! Source: PKWARE, *.ZIP File Format Specification*, version 6.3.10, 2022, sections 4.3.7, 4.3.12 and 4.3.16. Limits: no
//! ZIP64, so that an archive holds fewer than 65 536 files and 4 GiB. All files have the same date, so that the same content
//! gives the same archive.

use std::io::{self, Write};

use super::crc32;

/// Version of the format that a reader needs, times ten: files without compression.
const VERSION: u16 = 10;
/// Flag of names in UTF-8.
const UTF_8: u16 = 1 << 11;
/// The first day of the format: 1980-01-01.
const DATE: u16 = (1 << 5) | 1;

/// Writes an archive of these files: their paths in the archive, with `/` between folders, and their contents.
pub fn write_zip(writer: &mut dyn Write, files: &[(String, Vec<u8>)]) -> io::Result<()> {
    let mut directory: Vec<u8> = Vec::new();
    let mut offset = 0;
    for (path, content) in files {
        let fields = fields(path, content)?;
        let header = [&0x0403_4b50_u32.to_le_bytes()[..], &fields].concat();
        for part in [&header[..], path.as_bytes(), content] {
            writer.write_all(part)?;
        }
        directory.extend(0x0201_4b50_u32.to_le_bytes());
        directory.extend(VERSION.to_le_bytes());
        directory.extend(&fields);
        // No comment, the first disk, no attributes.
        directory.extend([0; 10]);
        directory.extend(in_four_bytes(offset)?);
        directory.extend(path.as_bytes());
        offset += header.len() + path.len() + content.len();
    }
    writer.write_all(&directory)?;
    let num = in_two_bytes(files.len())?;
    let mut end = Vec::from(0x0605_4b50_u32.to_le_bytes());
    // The first disk.
    end.extend([0; 4]);
    end.extend([num, num].as_flattened());
    end.extend(in_four_bytes(directory.len())?);
    end.extend(in_four_bytes(offset)?);
    // No comment.
    end.extend([0; 2]);
    writer.write_all(&end)
}

/// The fields that a file's header and its entry in the directory share.
fn fields(path: &str, content: &[u8]) -> io::Result<Vec<u8>> {
    let mut fields: Vec<u8> = Vec::new();
    // Not compressed; midnight.
    for number in [VERSION, UTF_8, 0, 0, DATE] {
        fields.extend(number.to_le_bytes());
    }
    fields.extend(crc32(content).to_le_bytes());
    let size = in_four_bytes(content.len())?;
    fields.extend([size, size].as_flattened());
    fields.extend(in_two_bytes(path.len())?);
    // Nothing extra.
    fields.extend([0; 2]);
    Ok(fields)
}

fn in_two_bytes(number: usize) -> io::Result<[u8; 2]> {
    let number = u16::try_from(number).map_err(io::Error::other)?;
    Ok(number.to_le_bytes())
}

fn in_four_bytes(number: usize) -> io::Result<[u8; 4]> {
    let number = u32::try_from(number).ok();
    let number = number.ok_or(io::ErrorKind::FileTooLarge)?;
    Ok(number.to_le_bytes())
}

/// Reads an archive that [`write_zip`] wrote, by its directory, for tests.
///
/// # Panics
/// If it is no such archive, or a checksum does not match.
#[cfg(any(test, feature = "fixtures"))]
pub fn read_zip(archive: &[u8]) -> Vec<(String, Vec<u8>)> {
    let number = |at: usize, size: usize| {
        let bytes = archive[at..at + size].iter().rev();
        bytes.fold(0, |number, byte| (number << 8) | usize::from(*byte))
    };
    let end = archive.len() - 22;
    assert_eq!(number(end, 4), 0x0605_4b50);
    let mut entry = number(end + 16, 4);
    let mut files = Vec::new();
    for _ in 0..number(end + 10, 2) {
        assert_eq!(number(entry, 4), 0x0201_4b50);
        let [size, name_length, header] =
            [(24, 4), (28, 2), (42, 4)].map(|(offset, size)| number(entry + offset, size));
        let name = &archive[entry + 46..][..name_length];
        assert_eq!(number(header, 4), 0x0403_4b50);
        assert_eq!(&archive[header + 30..][..name_length], name);
        let content = &archive[header + 30 + name_length..][..size];
        assert_eq!(number(entry + 16, 4), crc32(content) as usize);
        assert_eq!(
            archive[header + 4..header + 30],
            archive[entry + 6..entry + 32]
        );
        let name = String::from_utf8(name.to_vec()).expect("UTF-8");
        files.push((name, content.to_vec()));
        entry += 46 + name_length;
    }
    assert_eq!(entry, end);
    files
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_come_back_from_an_archive() {
        let files = [
            ("read-me.txt", &b"Teil"[..]),
            ("library/t\u{fc}r/cloud.ply", &vec![7; 70_000][..]),
            ("empty", &b""[..]),
        ];
        let files = files.map(|(path, content)| (path.to_owned(), content.to_vec()));
        let mut archive = Vec::new();
        write_zip(&mut archive, &files).expect("in memory");
        assert_eq!(read_zip(&archive), files);
        // As the specification lays out the first header and the end.
        assert_eq!(archive[..8], *b"PK\x03\x04\x0a\0\0\x08");
        assert_eq!(archive[26..41], *b"\x0b\0\0\0read-me.txt");
        assert_eq!(
            archive[archive.len() - 22..][..12],
            *b"PK\x05\x06\0\0\0\0\x03\0\x03\0"
        );
    }

    #[test]
    fn a_name_that_is_too_long_is_refused() {
        let file = ("x".repeat(1 << 16), Vec::new());
        assert!(write_zip(&mut Vec::new(), &[file]).is_err());
    }
}

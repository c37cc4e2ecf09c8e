//! Finds libcrumble: the file $CRUMBLE_LIBRARY (shared or archive), else in the folder $CRUMBLE_LIB_DIR, else as pkg-config
//! says.
use std::path::{Path, PathBuf};
use std::process::Command;
use std::{env, fs};

fn main() {
    for name in ["CRUMBLE_LIBRARY", "CRUMBLE_LIB_DIR", "PKG_CONFIG", "PKG_CONFIG_PATH"] {
        println!("cargo:rerun-if-env-changed={}", name);
    }
    if env::var_os("DOCS_RS").is_some() {
        return; // documentation links nothing
    }
    if let Some(file) = env::var_os("CRUMBLE_LIBRARY") {
        link_file(Path::new(&file));
    } else if let Some(folder) = env::var_os("CRUMBLE_LIB_DIR") {
        println!("cargo:rustc-link-search=native={}", Path::new(&folder).display());
        println!("cargo:rustc-link-lib=dylib=crumble");
    } else {
        link_as_pkg_config_says();
    }
}

/// The linker wants a name, and cargo lets programs that it runs find what lies in OUT_DIR: so the file gets its names
/// there.
fn link_file(file: &Path) {
    let file = fs::canonicalize(file).unwrap_or_else(|e| panic!("CRUMBLE_LIBRARY is {}: {}", file.display(), e));
    println!("cargo:rerun-if-changed={}", file.display());
    let folder = PathBuf::from(env::var_os("OUT_DIR").unwrap()).join("library");
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).unwrap();
    println!("cargo:rustc-link-search=native={}", folder.display());
    let is_archive = file.extension().map_or(false, |e| e == "a");
    for name in names(is_archive) {
        link_or_copy(&file, &folder.join(name));
    }
    if is_archive {
        println!("cargo:rustc-link-lib=static=crumble");
        println!("cargo:rustc-link-lib=dylib=fcl");
        println!("cargo:rustc-link-lib=dylib=ccd");
        println!("cargo:rustc-link-lib=dylib={}", if target_os() == "macos" { "c++" } else { "stdc++" });
    } else {
        println!("cargo:rustc-link-lib=dylib=crumble");
    }
}

/// What the linker looks for and, in a shared library, what the loader does.
fn names(is_archive: bool) -> Vec<String> {
    let version =
        format!("{}.{}", env::var("CARGO_PKG_VERSION_MAJOR").unwrap(), env::var("CARGO_PKG_VERSION_MINOR").unwrap());
    match target_os().as_str() {
        _ if is_archive => vec!["libcrumble.a".to_string()],
        "macos" => vec!["libcrumble.dylib".to_string(), format!("libcrumble.{}.dylib", version)],
        "windows" => panic!("on Windows set CRUMBLE_LIB_DIR to the folder of crumble.lib instead of CRUMBLE_LIBRARY"),
        _ => vec!["libcrumble.so".to_string(), format!("libcrumble.so.{}", version)],
    }
}

fn target_os() -> String {
    env::var("CARGO_CFG_TARGET_OS").unwrap()
}

#[cfg(unix)]
fn link_or_copy(file: &Path, name: &Path) {
    std::os::unix::fs::symlink(file, name).unwrap();
}

#[cfg(not(unix))]
fn link_or_copy(file: &Path, name: &Path) {
    fs::copy(file, name).unwrap();
}

fn link_as_pkg_config_says() {
    let program = env::var("PKG_CONFIG").unwrap_or_else(|_| "pkg-config".to_string());
    let hint =
        "set CRUMBLE_LIBRARY to libcrumble.so, CRUMBLE_LIB_DIR to its folder, or PKG_CONFIG_PATH to that of crumble.pc";
    let answer = Command::new(&program).args(["--libs", "crumble"]).output();
    let answer = answer.unwrap_or_else(|e| panic!("no libcrumble: {} does not run: {}; {}", program, e, hint));
    if !answer.status.success() {
        panic!("no libcrumble: {}; {}", String::from_utf8_lossy(&answer.stderr).trim(), hint);
    }
    for flag in String::from_utf8_lossy(&answer.stdout).split_whitespace() {
        if let Some(folder) = flag.strip_prefix("-L") {
            println!("cargo:rustc-link-search=native={}", folder);
        } else if let Some(library) = flag.strip_prefix("-l") {
            println!("cargo:rustc-link-lib=dylib={}", library);
        }
    }
}

//! The reference page is generated, and not stale.
#![allow(
    clippy::unwrap_used,
    clippy::panic,
    clippy::disallowed_methods,
    reason = "a test that panics fails, and its files are its own"
)]

#[test]
fn the_reference_page_is_what_the_catalogue_says() {
    let generated = maquette::commands::nodes::markdown(&maquette_nodes::catalogue().unwrap());
    let written = std::fs::read_to_string("docs/nodes.md").unwrap_or_default();
    assert!(
        written == generated,
        "docs/nodes.md is stale: run `cargo run --release -- nodes --markdown > docs/nodes.md`"
    );
}

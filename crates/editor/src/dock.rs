//! Where the panels stand: split, tabbed and dragged as the user likes, and remembered.

use egui_tiles::{Container, Linear, LinearDir, Tile, TileId, Tiles, Tree};
use serde::{Deserialize, Serialize};

use crate::viewport::camera::Direction;

/// A panel.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) enum Pane {
    View(Direction),
    Canvas,
    Inspector,
    Palette,
    Problems,
    History,
    Performance,
    Data,
    Help,
}

impl Pane {
    /// All panels, in the order of the menu.
    pub(crate) const ALL: [Self; 12] = [
        Self::View(Direction::Free),
        Self::View(Direction::Front),
        Self::View(Direction::Side),
        Self::View(Direction::Top),
        Self::Canvas,
        Self::Inspector,
        Self::Palette,
        Self::Problems,
        Self::History,
        Self::Performance,
        Self::Data,
        Self::Help,
    ];

    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::View(direction) => direction.name(),
            Self::Canvas => "Graph",
            Self::Inspector => "Inspector",
            Self::Palette => "Palette",
            Self::Problems => "Problems",
            Self::History => "History",
            Self::Performance => "Performance",
            Self::Data => "Data",
            Self::Help => "Help",
        }
    }
}

fn split(tiles: &mut Tiles<Pane>, direction: LinearDir, first: TileId, second: TileId, share: f32) -> TileId {
    let mut linear = Linear::new(direction, vec![first, second]);
    linear.shares.set_share(first, share);
    linear.shares.set_share(second, 1.0 - share);
    tiles.insert_container(Container::Linear(linear))
}

/// The layout of the first start: four views, the graph below, the inspector beside.
pub(crate) fn first_layout() -> Tree<Pane> {
    let mut tiles = Tiles::default();
    let mut pane = |pane| tiles.insert_pane(pane);
    let views = Direction::ALL.map(|direction| pane(Pane::View(direction)));
    let canvas = pane(Pane::Canvas);
    let sides = [Pane::Inspector, Pane::Palette, Pane::Help].map(&mut pane);
    let below = [Pane::Problems, Pane::History, Pane::Performance, Pane::Data].map(&mut pane);
    let [free, front, side, top] = views;
    let upper = split(&mut tiles, LinearDir::Horizontal, free, front, 0.5);
    let lower = split(&mut tiles, LinearDir::Horizontal, side, top, 0.5);
    let views = split(&mut tiles, LinearDir::Vertical, upper, lower, 0.5);
    let left = split(&mut tiles, LinearDir::Vertical, views, canvas, 0.56);
    let sides = tiles.insert_tab_tile(sides.to_vec());
    let below = tiles.insert_tab_tile(below.to_vec());
    let right = split(&mut tiles, LinearDir::Vertical, sides, below, 0.66);
    let root = split(&mut tiles, LinearDir::Horizontal, left, right, 0.76);
    Tree::new("dock", root, tiles)
}

/// Where a panel stands.
pub(crate) fn tile_of(tree: &Tree<Pane>, pane: Pane) -> Option<TileId> {
    tree.tiles.find_pane(&pane)
}

/// Whether a panel can be seen: no other tab is before it, and no other panel has the window for itself.
pub(crate) fn is_shown(tree: &Tree<Pane>, maximised: Option<Pane>, pane: Pane) -> bool {
    match maximised {
        Some(alone) => alone == pane,
        None => tile_of(tree, pane).is_some_and(|tile| tree.active_tiles().contains(&tile)),
    }
}

/// Brings a panel to the front, or back, where it was closed.
pub(crate) fn reveal(tree: &mut Tree<Pane>, pane: Pane) {
    let tile = match tile_of(tree, pane) {
        Some(tile) => tile,
        None => {
            let tile = tree.tiles.insert_pane(pane);
            match tree.root {
                Some(root) => tree.move_tile_to_container(tile, root, usize::MAX, false),
                None => tree.root = Some(tile),
            }
            tile
        }
    };
    tree.set_visible(tile, true);
    tree.make_active(|id, _: &Tile<Pane>| id == tile);
}

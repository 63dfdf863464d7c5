//! The node kinds of Maquette: where the engine ([`maquette_graph`]) and the mathematics ([`maquette_geometry`])
//! meet. One file a node; [`catalogue`] registers them all.

mod affine;
mod anchor;
mod curve;
mod deform;
mod edges;
mod fitting;
mod frozen;
mod generate;
mod input;
mod mesh;
mod neighbours;
mod output;
mod placement;
mod primitive;
pub mod results;
mod section;
mod select;
mod selecting;
mod silhouettes;
mod stiffness;
mod surface;
mod surfacing;
mod view_plane;
pub mod wire;

use maquette_geometry::mesh::join;
use maquette_geometry::sections::Sections;
use maquette_graph::{Catalogue, CatalogueError, NodeKind};

/// Every node kind of this library, in the order of the source tree. A file that is not listed fails
/// `tests/every_node.rs`.
fn kinds() -> Vec<NodeKind> {
    vec![
        curve::beam_reference::kind(),
        curve::boundary_of::kind(),
        curve::clean_strokes::kind(),
        curve::compare_curves::kind(),
        curve::draw_on_surface::kind(),
        curve::join::kind(),
        curve::join_borders::kind(),
        curve::mirror::kind(),
        curve::pick::kind(),
        curve::resample::kind(),
        curve::simplify::kind(),
        curve::smooth::kind(),
        curve::sort::kind(),
        curve::split_border::kind(),
        curve::transform::kind(),
        deform::align_primitive::kind(),
        deform::beam::kind(),
        deform::bind_deformation::kind(),
        deform::deform::kind(),
        deform::deform_by_cross_section::kind(),
        deform::deform_to_curves::kind(),
        deform::deform_to_silhouette::kind(),
        deform::handle::kind(),
        generate::blend::kind(),
        generate::detail_generator::kind(),
        input::import_curves::kind(),
        input::import_mesh::kind(),
        input::import_skeleton::kind(),
        input::sketch::kind(),
        input::trace_image::kind(),
        mesh::caps::kind(),
        mesh::compare_meshes::kind(),
        mesh::cut_with_curve::kind(),
        mesh::cut_with_plane::kind(),
        mesh::join_meshes::kind(),
        mesh::join_parts::kind(),
        mesh::measure_mesh::kind(),
        mesh::mesh_smooth::kind(),
        mesh::mirror_mesh::kind(),
        mesh::resample_border::kind(),
        mesh::silhouette_of::kind(),
        mesh::silhouette_report::kind(),
        mesh::transform_mesh::kind(),
        output::curves_out::kind(),
        output::mesh_out::kind(),
        primitive::primitive_shape::kind(),
        primitive::superellipsoid::kind(),
        section::curves_from_sections::kind(),
        section::edit_section::kind(),
        section::ellipse::kind(),
        section::fit_report::kind(),
        section::fit_sections::kind(),
        section::order_sections::kind(),
        section::pick_sections::kind(),
        section::sections_from_mesh::kind(),
        select::change_selection::kind(),
        select::combine_selections::kind(),
        select::select_by_distance::kind(),
        select::select_by_mesh::kind(),
        select::select_by_name::kind(),
        select::select_by_normal::kind(),
        select::select_by_shape::kind(),
        select::select_by_stroke::kind(),
        select::select_nearest::kind(),
        select::select_points::kind(),
        select::split_by_selection::kind(),
        surface::continuity_report::kind(),
        surface::join_surfaces::kind(),
        surface::section_at::kind(),
        surface::surface_from_cross_sections::kind(),
        surface::tessellate::kind(),
    ]
}

/// The catalogue of all node kinds, wire types and conversions of this library.
///
/// # Errors
/// A kind is declared twice or its default does not fit; the tests keep that from ever being shipped.
pub fn catalogue() -> Result<Catalogue, CatalogueError> {
    let mut catalogue = Catalogue::new();
    catalogue.conversion::<wire::Curve, wire::Curves>(|curve| Ok(wire::Curves(vec![curve.0.clone()])))?;
    catalogue.conversion::<wire::Curves, wire::Curve>(|curves| match curves.0.as_slice() {
        [curve] => Ok(wire::Curve(curve.clone())),
        several => Err(format!("{} curves arrive where one is wanted: choose it with a `pick` node", several.len())),
    })?;
    catalogue.conversion::<wire::Borders, wire::Curves>(|borders| {
        Ok(wire::Curves(borders.0.iter().map(|border| border.curve().clone()).collect()))
    })?;
    catalogue.conversion::<wire::Mesh, wire::Shape>(|mesh| Ok(wire::Shape::Mesh(mesh.clone())))?;
    catalogue.conversion::<wire::Surface, wire::Shape>(|surface| Ok(wire::Shape::Surface(surface.clone())))?;
    catalogue.conversion::<wire::Sections, wire::Shape>(|sections| Ok(wire::Shape::Sections(sections.clone())))?;
    catalogue.collect::<wire::Borders, wire::Borders>(|lists| {
        Ok(wire::Borders(lists.iter().flat_map(|list| list.0.iter().cloned()).collect()))
    })?;
    catalogue.list::<wire::Curves, wire::Curve>(
        |curves| curves.0.iter().cloned().map(wire::Curve).collect(),
        |curves| Ok(wire::Curves(curves.iter().map(|curve| curve.0.clone()).collect())),
    )?;
    catalogue.collect::<wire::Curves, wire::Curves>(|lists| {
        Ok(wire::Curves(lists.iter().flat_map(|list| list.0.iter().cloned()).collect()))
    })?;
    catalogue.collect::<wire::Mesh, wire::Mesh>(|meshes| {
        let joined = join(meshes.iter().map(|mesh| &*mesh.0)).map_err(|error| error.to_string())?;
        Ok(wire::Mesh::new(joined))
    })?;
    catalogue
        .conversion::<wire::Sections, wire::CrossSections>(|points| Ok(wire::CrossSections::Points(points.clone())))?;
    catalogue.conversion::<wire::EllipticSections, wire::CrossSections>(|series| {
        Ok(wire::CrossSections::Series(series.clone()))
    })?;
    // Binding takes no notice of how handles move, and so is not done again while they are dragged.
    catalogue.conversion::<wire::Handles, wire::Held>(|handles| Ok(handles.held()))?;
    catalogue.collect::<wire::Handles, wire::Handles>(|lists| {
        Ok(wire::Handles(lists.iter().flat_map(|list| list.0.iter().cloned()).collect()))
    })?;
    catalogue.collect::<wire::EllipticSections, wire::EllipticSections>(|stacks| {
        Ok(wire::EllipticSections::new(stacks.iter().flat_map(|stack| stack.0.iter().cloned()).collect()))
    })?;
    catalogue
        .conversion::<wire::EllipticSections, wire::Curves>(|series| fitting::as_curves(&series.0).map(wire::Curves))?;
    catalogue
        .conversion::<wire::Sections, wire::Curves>(|sections| sections_as_curves(&sections.0).map(wire::Curves))?;
    frozen::register(&mut catalogue);
    for kind in kinds() {
        catalogue.register(kind)?;
    }
    Ok(catalogue)
}

/// Sections of points as curves of their points.
fn sections_as_curves(sections: &Sections) -> Result<Vec<maquette_geometry::curve::Curve>, String> {
    let as_curve = |(index, points): (usize, &[glam::DVec3])| {
        maquette_geometry::curve::Curve::new(format!("section {index}"), points.to_vec(), sections.is_closed()).map_err(
            |error| {
                format!(
                    "section {index} is no curve: {error}; a `curves-from-sections` node leaves out sections that are \
                     a point"
                )
            },
        )
    };
    sections.iter().enumerate().map(as_curve).collect()
}

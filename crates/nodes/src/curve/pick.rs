//! **Pick**: one curve out of a list.

use maquette_graph::{AtPort, NodeKind};

use crate::wire;

pub(crate) fn kind() -> NodeKind {
    let mut node = NodeKind::declare("pick", 1, "curve", "Picks one curve out of a list, by name or number.");
    let curves = node.input::<wire::Curves>("curves", "The list.");
    let which = node.text("which", "0", "Name of the curve, or its number counted from 0.");
    let picked = node.output::<wire::Curve>("curve", "The curve.");
    node.evaluate(move |ports| {
        let list = &ports.read(curves).0;
        let wanted = ports.read(which).trim();
        let named: Vec<_> = list.iter().filter(|curve| curve.name() == wanted).collect();
        let found = match named.as_slice() {
            [curve] => Some(*curve),
            [] => wanted.parse::<usize>().ok().and_then(|number| list.get(number)),
            several => {
                let message = format!("{} curves are named \"{wanted}\": give a number instead", several.len());
                return Err(message).at(which);
            }
        };
        let Some(curve) = found else {
            let known: Vec<_> = list.iter().enumerate().map(|(i, c)| format!("{i} \"{}\"", c.name())).collect();
            let known = if known.is_empty() { "none; the list is empty".to_owned() } else { known.join(", ") };
            return Err(format!("no curve is called \"{wanted}\"; there is {known}")).at(which);
        };
        ports.write(picked, wire::Curve(curve.clone()));
        Ok(())
    });
    node
}

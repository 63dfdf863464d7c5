//! Edits of what a graph takes and gives as a whole.

use crate::catalogue::Catalogue;
use crate::edit::{Edit, EditError};
use crate::graph::{Graph, NodeId, Source};
use crate::interface::{GraphOutput, InterfaceError};
use crate::parameter::Parameter;

impl Graph {
    pub(super) fn insert_parameter(&mut self, index: usize, parameter: &Parameter) -> Result<Edit, EditError> {
        self.check_parameter(parameter, None)?;
        self.parameters.insert(index.min(self.parameters.len()), parameter.clone());
        self.touch_all();
        Ok(Edit::RemoveParameter(parameter.name().to_owned()))
    }

    /// Removes a parameter; the inputs that it drove get its value.
    pub(super) fn take_parameter(&mut self, catalogue: &Catalogue, name: &str) -> Result<Edit, EditError> {
        let index = self.parameter_index(name)?;
        let parameter = self.parameters[index].clone();
        let mut restoring = Vec::new();
        for (node, input) in self.uses(name) {
            restoring.push(self.release(catalogue, node, &input, &parameter));
        }
        self.parameters.remove(index);
        self.touch_all();
        Ok(with_restoring(Edit::AddParameter { index, parameter: Box::new(parameter) }, restoring))
    }

    /// Puts the value of a parameter in its place at an input, or nothing where it does not fit; gives the edit that puts
    /// the parameter back.
    fn release(&mut self, catalogue: &Catalogue, node: NodeId, input: &str, parameter: &Parameter) -> Edit {
        let spec = self.node(node).and_then(|node| node.kind()?.find_input(input)).cloned();
        let literal = parameter.value().and_then(|value| match &spec {
            None => Some(value.clone()),
            Some(spec) if spec.wire == parameter.wire() || catalogue.fits(parameter.wire(), spec.wire) => {
                spec.refuses(value).is_none().then(|| spec.normal(value.clone()))
            }
            Some(_) => None,
        });
        let was = self.put(node, input, literal.map(Source::literal));
        Edit::restoring(node, input, was)
    }

    pub(super) fn change_parameter(
        &mut self,
        catalogue: &Catalogue,
        name: &str,
        parameter: &Parameter,
    ) -> Result<Edit, EditError> {
        let index = self.parameter_index(name)?;
        self.check_parameter(parameter, Some(name))?;
        let was = std::mem::replace(&mut self.parameters[index], parameter.clone());
        let mut restoring = Vec::new();
        for (node, input) in self.uses(name) {
            self.put(node, &input, Some(Source::Parameter(parameter.name().to_owned())));
            if self.check_use(catalogue, node, &input, parameter.name()).is_err() {
                restoring.push(self.release(catalogue, node, &input, &was));
            }
        }
        // Those that were released come back under the name that the parameter has then.
        let restoring = restoring.into_iter().map(|edit| match edit {
            Edit::UseParameter { node, input, .. } => Edit::UseParameter { node, input, parameter: name.to_owned() },
            other => other,
        });
        let restoring = restoring.collect();
        self.touch_all();
        let back = Edit::ChangeParameter { name: parameter.name().to_owned(), parameter: Box::new(was) };
        Ok(with_restoring(back, restoring))
    }

    pub(super) fn insert_output(&mut self, index: usize, output: &GraphOutput) -> Result<Edit, EditError> {
        self.check_output(output, None)?;
        self.outputs.insert(index.min(self.outputs.len()), output.clone());
        self.touch_all();
        Ok(Edit::RemoveOutput(output.name().to_owned()))
    }

    pub(super) fn take_output(&mut self, name: &str) -> Result<Edit, InterfaceError> {
        let index = self.output_index(name)?;
        let output = Box::new(self.outputs.remove(index));
        self.touch_all();
        Ok(Edit::AddOutput { index, output })
    }

    pub(super) fn change_output(&mut self, name: &str, output: &GraphOutput) -> Result<Edit, EditError> {
        let index = self.output_index(name)?;
        self.check_output(output, Some(name))?;
        let was = std::mem::replace(&mut self.outputs[index], output.clone());
        self.touch_all();
        Ok(Edit::ChangeOutput { name: output.name().to_owned(), output: Box::new(was) })
    }
}

/// An inverse, followed by what brings back what had to go.
pub(super) fn with_restoring(inverse: Edit, restoring: Vec<Edit>) -> Edit {
    if restoring.is_empty() { inverse } else { Edit::Several(std::iter::once(inverse).chain(restoring).collect()) }
}

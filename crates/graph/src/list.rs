//! Which wire types are lists of others, and what several values of a type become when they are collected.

use std::sync::Arc;

use crate::catalogue::{Catalogue, CatalogueError};
use crate::value::{Value, Wire, WireType};

pub(crate) type SplitFn = dyn Fn(&Value) -> Result<Vec<Value>, String> + Send + Sync;
pub(crate) type JoinFn = dyn Fn(&[Value]) -> Result<Value, String> + Send + Sync;

/// A type whose values are lists of values of another.
#[derive(Clone)]
pub(crate) struct ListType {
    pub(crate) list: WireType,
    pub(crate) item: WireType,
    pub(crate) split: Arc<SplitFn>,
}

/// How several values become one.
#[derive(Clone)]
pub(crate) struct Collection {
    pub(crate) item: WireType,
    pub(crate) collected: WireType,
    pub(crate) join: Arc<JoinFn>,
}

impl Catalogue {
    /// Declares that `L` is a list of `I`: a `repeat` node with `each` takes an `L` apart with `split`, and an output
    /// of type `I` is collected with `join`.
    ///
    /// # Errors
    /// `I` has a list type, or is collected, already.
    pub fn list<L: Wire, I: Wire>(
        &mut self,
        split: impl Fn(&L) -> Vec<I> + Send + Sync + 'static,
        join: impl Fn(&[&I]) -> Result<L, String> + Send + Sync + 'static,
    ) -> Result<(), CatalogueError> {
        if self.list_of(WireType::of::<I>()).is_some() {
            return Err(CatalogueError::DuplicateList(I::NAME));
        }
        self.collect::<I, L>(join)?;
        let split = Arc::new(move |value: &Value| match value.get::<L>() {
            Some(list) => Ok(split(list).into_iter().map(Value::new).collect()),
            None => Err(format!("a {} arrived where {} were expected", value.wire(), L::NAME)),
        });
        self.lists.push(ListType { list: WireType::of::<L>(), item: WireType::of::<I>(), split });
        Ok(())
    }

    /// Declares what several values of type `I` become when a `repeat` node collects them; there may be none of them.
    ///
    /// # Errors
    /// `I` is collected already.
    pub fn collect<I: Wire, C: Wire>(
        &mut self,
        join: impl Fn(&[&I]) -> Result<C, String> + Send + Sync + 'static,
    ) -> Result<(), CatalogueError> {
        if self.collection_of(WireType::of::<I>()).is_some() {
            return Err(CatalogueError::DuplicateList(I::NAME));
        }
        let join = Arc::new(move |values: &[Value]| {
            let items: Option<Vec<&I>> = values.iter().map(Value::get::<I>).collect();
            join(&items.ok_or_else(|| format!("something else arrived where each is {}", I::NAME))?).map(Value::new)
        });
        self.add_wire(WireType::of::<I>())?;
        self.add_wire(WireType::of::<C>())?;
        let (item, collected) = (WireType::of::<I>(), WireType::of::<C>());
        self.collections.push(Collection { item, collected, join });
        Ok(())
    }

    /// The type whose values are lists of this one.
    pub(crate) fn list_of(&self, item: WireType) -> Option<&ListType> {
        self.lists.iter().find(|list| list.item == item)
    }

    /// How values of this type are collected.
    pub(crate) fn collection_of(&self, item: WireType) -> Option<&Collection> {
        self.collections.iter().find(|collection| collection.item == item)
    }

    /// What is collected to what, as pairs of types; the second is `true` where it can be taken apart again.
    pub fn collections(&self) -> impl Iterator<Item = (WireType, WireType, bool)> + '_ {
        let splits = |c: &Collection| self.list_of(c.item).is_some_and(|list| list.list == c.collected);
        self.collections.iter().map(move |c| (c.item, c.collected, splits(c)))
    }
}

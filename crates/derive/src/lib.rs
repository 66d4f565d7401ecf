//! `#[derive(Advice)]`: what to do about an error stands beside its message.

use proc_macro2::{Ident, TokenStream, TokenTree};
use quote::{format_ident, quote};
use syn::{
    Attribute, Data, DeriveInput, Error, Fields, Meta, MetaNameValue, Result, parse_macro_input,
};

/// Implements `geometry::error::Advice` with the `#[advice …]` of the struct, or of each variant of the enum; that of
/// the enum is for the variants without one:
///
/// - `#[advice = "Correct line {line}"]`: a sentence, with fields and constants as in `format!`;
/// - `#[advice("Correct {}", path.display())]`: the same with arguments;
/// - `#[advice(advice_on(source))]`: an expression, `&str` or `String`;
/// - `#[advice(transparent)]`: the advice of the only field.
///
/// The fields are in scope as references, those without a name as `_0`, `_1`; so is `self`.
#[proc_macro_derive(Advice, attributes(advice))]
pub fn derive_advice(input: proc_macro::TokenStream) -> proc_macro::TokenStream {
    let input = parse_macro_input!(input as DeriveInput);
    expand(&input)
        .unwrap_or_else(Error::into_compile_error)
        .into()
}

fn expand(input: &DeriveInput) -> Result<TokenStream> {
    let name = &input.ident;
    let general = only(&input.attrs, name)?;
    let arms = match &input.data {
        Data::Enum(data) => {
            let arms = data.variants.iter().map(|variant| {
                let name = &variant.ident;
                let advice = only(&variant.attrs, name)?.or(general);
                arm(&quote!(Self::#name), &variant.fields, advice)
            });
            arms.collect::<Result<Vec<_>>>()?
        }
        Data::Struct(data) => vec![arm(&quote!(Self), &data.fields, general)?],
        Data::Union(_) => return Err(Error::new_spanned(input, "a union has no advice")),
    };
    let (impl_generics, ty_generics, where_clause) = input.generics.split_for_impl();
    Ok(quote! {
        #[automatically_derived]
        impl #impl_generics ::geometry::error::Advice for #name #ty_generics #where_clause {
            #[allow(
                unused_variables,
                clippy::used_underscore_binding,
                reason = "all fields are bound, for the advice to use"
            )]
            fn advice(&self) -> ::std::string::String {
                match self {
                    #(#arms)*
                }
            }
        }
    })
}

/// The `#[advice …]` among the attributes of `item`.
fn only<'a>(attributes: &'a [Attribute], item: &Ident) -> Result<Option<&'a Attribute>> {
    let mut advice = attributes.iter().filter(|it| it.path().is_ident("advice"));
    let (first, second) = (advice.next(), advice.next());
    match second {
        Some(_) => Err(Error::new_spanned(item, "more than one #[advice …]")),
        None => Ok(first),
    }
}

/// The arm of the `match` for one variant, or for the struct.
fn arm(path: &TokenStream, fields: &Fields, advice: Option<&Attribute>) -> Result<TokenStream> {
    let Some(attribute) = advice else {
        let message = "say what to do about it, for example #[advice = \"Try again\"]";
        return Err(Error::new_spanned(path, message));
    };
    let names = fields.iter().enumerate().map(|(index, field)| {
        let unnamed = || format_ident!("_{index}");
        field.ident.clone().unwrap_or_else(unnamed)
    });
    let names: Vec<Ident> = names.collect();
    let pattern = match fields {
        Fields::Named(_) => quote!(#path { #(#names),* }),
        Fields::Unnamed(_) => quote!(#path(#(#names),*)),
        Fields::Unit => path.clone(),
    };
    let text = match &attribute.meta {
        Meta::NameValue(MetaNameValue { value, .. }) => quote!(::std::format!(#value)),
        meta => {
            let tokens = &meta.require_list()?.tokens;
            match tokens.clone().into_iter().next() {
                Some(TokenTree::Literal(_)) => quote!(::std::format!(#tokens)),
                Some(TokenTree::Ident(word)) if word == "transparent" => {
                    let [field] = &names[..] else {
                        let message = "transparent needs exactly one field";
                        return Err(Error::new_spanned(attribute, message));
                    };
                    quote!({
                        use ::geometry::error::Advice as _;
                        #field.advice()
                    })
                }
                _ => quote!(::std::string::String::from(#tokens)),
            }
        }
    };
    Ok(quote!(#pattern => #text,))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[track_caller]
    fn refused(code: &str) -> String {
        let input = syn::parse_str(code).expect("an item");
        let refused = expand(&input).expect_err("an error of the macro");
        refused.to_string()
    }

    #[test]
    fn each_variant_must_say_what_to_do_and_once() {
        let none = refused("enum E { #[advice = \"Wait\"] A, B { line: usize } }");
        assert!(none.starts_with("say what to do"), "{none}");
        let two = refused("#[advice = \"Wait\"] #[advice = \"Run\"] struct E;");
        assert!(two.starts_with("more than one"), "{two}");
        let empty = refused("#[advice] struct E;");
        assert!(empty.contains("advice(...)"), "{empty}");
    }

    #[test]
    fn only_a_single_field_can_give_the_advice() {
        let two = refused("enum E { #[advice(transparent)] A(Inner, usize) }");
        assert!(two.contains("exactly one field"), "{two}");
        let none = refused("enum E { #[advice(transparent)] A }");
        assert!(none.contains("exactly one field"), "{none}");
    }
}

# Ayuda: la guía, el programa y el ordenador, los informes de problemas y la búsqueda

help-guide = Guía
help-about = Acerca de
help-report = Informar de un problema
help-search = Buscar teclas y en la guía
help-nothing-found = No se encontró nada: pruebe con menos palabras o más cortas
help-keys-and-actions = Teclas y acciones
help-guide-in-english = La guía está en inglés
help-version = Versión
help-system = Sistema
help-graphics = Adaptador gráfico
help-folders = Carpetas en uso
help-library = Biblioteca
help-cases = Casos
help-recipes = Recetas
help-settings = Ajustes
help-copy = Copiar
help-copy-path = Copiar la ruta: { $what }
help-licences = Licencias
help-licences-say = Partsight es software libre bajo la licencia MIT o la Apache 2.0. docs/DEPENDENCIES.md indica los paquetes con los que está construido y cómo listar sus licencias
help-report-says = Un informe de problema es un archivo ZIP con lo que otra persona necesita para ver lo mismo que usted. Se queda en este ordenador hasta que usted lo envíe
help-report-inside = Contendrá
help-report-no-scene = Ninguna escena: aún no se ha inspeccionado nada
help-report-scene = La escena de la pantalla: { $scene }, con su resultado
help-report-first-shot = La primera toma de { $scene }, con el resultado del escaneo
help-report-entries = { $num ->
        [one] La entrada de la biblioteca con la que se comparó: { $part }
       *[other] Las { $num } entradas de la biblioteca con las que se comparó: { $part }
    }
help-report-recipe = La receta { $recipe }
help-report-system = Las versiones del programa y del sistema, y el adaptador gráfico
help-report-settings = Los ajustes de la ventana, con las rutas de sus archivos
help-report-log = { $num ->
        [one] { $num } aviso de esta ventana
       *[other] { $num } avisos de esta ventana
    }
help-report-without = El PIN, las direcciones de red, los números de serie, las órdenes y el nombre del operador no figuran ni en los ajustes ni en el resultado
help-report-save = Guardar el informe…
help-report-writing = Escribiendo un informe de problema
help-zip-files = Archivos ZIP
